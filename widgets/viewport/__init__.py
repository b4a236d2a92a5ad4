"""The 3D viewport; the only room that knows vispy.

What vispy does for us: `vispy.app.Canvas` is the widget with a GL context that Qt embeds, and `vispy.gloo` has
programs, buffers and textures as Python objects that reach the driver when they are drawn with. Its scene graph,
visuals and cameras are not used: players by the dozen are skinned and drawn with shaders of our own, and the camera is
a value that is tested without a display (`widgets.viewport.camera`). Only public names of both modules are used. Where
Qt knows more than vispy (why there is no context, pictures of any size) Qt is asked directly
(`widgets.viewport.canvas`), and a state for which gloo has no name goes through the context's public queue, ``glir``.
"""
