// Plays a VRM animation on a VRM, as three.js does with pixiv's packages, and prints where everything is and what
// glTF's validator finds in the animation.
// node play_vrma.mjs NODE_MODULES FIGURE.vrm ANIMATION.vrma FPS FRAME...
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import path from 'node:path';

const [modules, figure, motion, fps, ...frames] = process.argv.slice(2);
const at = (file) => import(pathToFileURL(path.resolve(modules, file)).href);
globalThis.self = globalThis;
console.warn = console.info = (...words) => process.stderr.write(`WARNING ${words.join(' ')}\n`);

const THREE = await at('three/build/three.module.js');
const { GLTFLoader } = await at('three/examples/jsm/loaders/GLTFLoader.js');
const { VRMLoaderPlugin } = await at('@pixiv/three-vrm/lib/three-vrm.module.js');
const { VRMAnimationLoaderPlugin, VRMLookAtQuaternionProxy, createVRMAnimationClip } = await at(
  '@pixiv/three-vrm-animation/lib/three-vrm-animation.module.js',
);

const loader = new GLTFLoader();
loader.register((parser) => new VRMLoaderPlugin(parser));
loader.register((parser) => new VRMAnimationLoaderPlugin(parser));
async function load(file) {
  const bytes = readFileSync(file);
  return loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
}

const { vrm } = (await load(figure)).userData;
const [animation] = (await load(motion)).userData.vrmAnimations;
const proxy = new VRMLookAtQuaternionProxy(vrm.lookAt);
proxy.name = 'gaze';
vrm.scene.add(proxy);
const mixer = new THREE.AnimationMixer(vrm.scene);
mixer.clipAction(createVRMAnimationClip(animation, vrm)).play();
const places = [];
for (const frame of frames) {
  mixer.setTime(Number(frame) / Number(fps));
  vrm.update(0);
  vrm.scene.updateWorldMatrix(true, true);
  const bones = {};
  for (const name of Object.keys(vrm.humanoid.humanBones)) {
    const node = vrm.humanoid.getRawBoneNode(name);
    bones[name] = [...node.getWorldPosition(new THREE.Vector3()), ...node.getWorldQuaternion(new THREE.Quaternion())];
  }
  const expressions = {};
  for (const one of vrm.expressionManager?.expressions ?? []) expressions[one.expressionName] = one.weight;
  places.push({ bones, expressions, gaze: [vrm.lookAt.yaw, vrm.lookAt.pitch] });
}
const validator = createRequire(import.meta.url)(path.resolve(modules, 'gltf-validator'));
const { issues } = await validator.validateBytes(new Uint8Array(readFileSync(motion)));
process.stdout.write(JSON.stringify({ duration: animation.duration, places, issues: issues.messages }));
