"""The timeline: ruler, piano roll and lanes over one time axis.

Displayed values, hit testing and the meaning of gestures are in `widgets.timeline.model`, which is independent of Qt;
the widgets here draw and pass on events.

pyqtgraph is not used here. Its plots are scenes of graphics items whose views change one after another, and each change
repainted all lanes (see `widgets.timeline.plot.plot.Plot`). Passing thousands of rectangles to Qt at once, which needs
a private class of it, is done in `widgets.timeline.plot.drawing` with numpy and the public ``shiboken6.wrapInstance``.
pyqtgraph draws the plot in the dialog of cuts (`widgets.dialogs.choreography.cut_plot`), for its axes and curves. vispy
is used by `widgets.viewport`.
"""
