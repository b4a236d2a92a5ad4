"""The timeline: ruler, piano roll and lanes over one time axis.

What is shown, what lies under the mouse and what gestures on it mean are values and functions in
`widgets.timeline.model`, which knows no Qt; the widgets here draw them and pass events on.

Of pyqtgraph nothing is used here. Its plots are scenes of graphics items whose views get changes one after another,
and each round painted all lanes again (see `widgets.timeline.plot.plot.Plot`). All it did for the timeline was to hand
Qt thousands of rectangles at once, through a class that it keeps for itself; `widgets.timeline.plot.drawing` does that
with numpy and the public ``shiboken6.wrapInstance``. pyqtgraph draws the plot in the dialog of cuts
(`widgets.dialogs.choreography.cut_plot`), where its axes and curves are what is needed. vispy is the viewport's, see
`widgets.viewport`.
"""
