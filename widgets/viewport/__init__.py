"""The 3D viewport; the only package that uses vispy.

Uses of vispy: `vispy.app.Canvas` is the widget with a GL context that Qt embeds, and `vispy.gloo` has programs, buffers
and textures as Python objects that are sent to the driver when used. Its scene graph, visuals and cameras are not used:
many players are skinned and drawn with the program's own shaders, and the camera is a value that can be tested without
a display (`widgets.viewport.camera`). Only public names of both modules are used. Where Qt provides more than vispy
(reasons for a missing context, pictures of any size), Qt is used directly (`widgets.viewport.canvas`), and a state for
which gloo has no name is set through the context's public queue, ``glir``.
"""
