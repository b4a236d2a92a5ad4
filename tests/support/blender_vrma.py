"""Plays a VRM animation on a VRM in Blender, by the VRM Add-on (bpy-vrm-format), and prints where all bones are.

Run by Blender's Python: ``blender_vrma.py FIGURE.vrm ANIMATION.vrma FPS FRAME...``; metres, Y up, as in the file.
"""

import json
import sys

import bpy  # type: ignore[import-not-found]

figure, motion, fps, *frames = sys.argv[1:]
bpy.ops.preferences.addon_enable(module="io_scene_vrm")
bpy.context.scene.render.fps = int(fps)
bpy.context.scene.render.fps_base = 1.0
assert bpy.ops.import_scene.vrm(filepath=figure) == {"FINISHED"}
(armature,) = (one for one in bpy.data.objects if one.type == "ARMATURE")
assert bpy.ops.import_scene.vrma(filepath=motion, armature_object_name=armature.name) == {"FINISHED"}
bones = armature.data.vrm_addon_extension.vrm1.humanoid.human_bones.human_bone_name_to_human_bone()
places = []
for frame in frames:
    # The add-on counts frames from one.
    bpy.context.scene.frame_set(int(frame) + 1)
    found = {}
    for name, bone in bones.items():
        if bone.node.bone_name:
            x, y, z = armature.matrix_world @ armature.pose.bones[bone.node.bone_name].head
            found[name.value] = [x, z, -y]
    places.append({"bones": found})
print("PLACES " + json.dumps({"places": places}))
