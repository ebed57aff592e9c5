// The picture: the surface, the probe and the camera.

import * as THREE from './three.module.js';
import {OrbitControls} from './OrbitControls.js';
import {Markers} from './marker.js';
import {cssColour} from './pages.js';
import {ShapeLoader} from './shape.js';
import {Surface} from './surface.js';

const kFieldOfView = 38;       // degrees
const kGrab = {mouse: 20, touch: 34};  // dots around the probe at which it can be dragged
const kSettleMs = 120;         // without a motion of the camera, the shape is loaded for it

// A colour of the style sheet as three numbers.
function colourOf(name) {
  const number = parseInt(cssColour(name).slice(1), 16);
  return [number >> 16, number >> 8 & 255, number & 255].map((part) => part / 255);
}

export class Picture {
  // stage: the element to draw in.
  constructor(stage, info, probe) {
    this.stage = stage;
    this.info = info;
    this.probe = probe;
    this.renderer = new THREE.WebGLRenderer({antialias: true});
    this.canvas = this.renderer.domElement;
    this.canvas.setAttribute('aria-hidden', 'true');
    stage.prepend(this.canvas);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 0.001, 100);
    this.surface = new Surface(this.scene, info.instances);
    this.markers = new Markers(this.scene);
    this.onDrawn = () => {};
    this.onError = () => {};
    this.loader = new ShapeLoader((shape) => this.setShape(shape));
    const lower = this.fromModel(info.core_lower), upper = this.fromModel(info.core_upper);
    this.middle = lower.clone().add(upper).multiplyScalar(0.5);
    this.radius = Math.max(1e-6, upper.distanceTo(lower) / 2);
    this.setUp('y');
    this.watch();
    this.setTheme();
  }

  // The scene is in the model frame, relative to its centre, so that floats suffice.
  fromModel(point) {
    return new THREE.Vector3(...point.map((value, i) => (value - this.info.centre[i]) / this.info.unit));
  }
  toModel(vector) { return vector.toArray().map((value, i) => this.info.centre[i] + value * this.info.unit); }

  watch() {
    new ResizeObserver(() => this.resize()).observe(this.stage);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.setTheme());
    // Before the controls see them.
    this.stage.addEventListener('pointerdown', (event) => this.grab(event), {capture: true});
    this.stage.addEventListener('pointermove', (event) => this.point(event), {capture: true});
    for (const name of ['pointerup', 'pointercancel'])
      this.stage.addEventListener(name, (event) => this.release(event), {capture: true});
    this.resize();
  }

  setUp(axis) {
    this.camera.up.set(0, axis === 'y' ? 1 : 0, axis === 'z' ? 1 : 0);
    this.surface.uniforms.up.value.copy(this.camera.up);
    this.controls?.dispose();
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.addEventListener('change', () => this.moved());
    this.controls.addEventListener('start', () => { this.isTurned = true; });
    this.reset();
  }

  reset() {
    this.isTurned = false;
    const isUpY = this.camera.up.y === 1;
    const from = new THREE.Vector3(0.55, isUpY ? 0.4 : -0.9, isUpY ? 0.9 : 0.4).normalize();
    // A narrow window shows the probe beside the model too.
    const room = this.camera.aspect < 1 ? 1 : 0.8;
    const half = Math.tan(THREE.MathUtils.degToRad(kFieldOfView / 2)) * Math.min(1, this.camera.aspect);
    this.controls.target.copy(this.middle);
    this.camera.position.copy(this.middle).addScaledVector(from, room * this.radius * Math.hypot(1, 1 / half));
    this.controls.minDistance = this.radius * 1e-4;
    this.controls.maxDistance = this.radius * 50;
    this.controls.update();
    this.moved();
  }

  // Looks at a box of the model from where the view is reset to.
  lookAt(lower, upper) {
    const from = this.fromModel(lower), to = this.fromModel(upper);
    this.reset();
    const way = this.camera.position.clone().sub(this.controls.target);
    this.controls.target.copy(from).add(to).multiplyScalar(0.5);
    const share = Math.min(1, Math.max(1e-3, to.distanceTo(from) / (2 * this.radius)));
    this.camera.position.copy(this.controls.target).addScaledVector(way, share);
    this.isTurned = true;
    this.controls.update();
    this.moved();
  }

  setTheme() {
    this.renderer.setClearColor(new THREE.Color().setRGB(...colourOf('--sky'), THREE.SRGBColorSpace));
    this.surface.setColours(colourOf);
    this.markers.setColours(colourOf);
    this.draw();
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.stage;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    // Until the reader turns the view, all of the model stays in it.
    if (this.isTurned) this.moved();
    else this.reset();
  }

  // The camera has moved, or what it sees.
  moved() {
    this.draw();
    clearTimeout(this.settling);
    this.settling = setTimeout(() => this.load(), kSettleMs);
  }

  load() {
    const look = new THREE.Vector3();
    this.camera.getWorldDirection(look);
    const half = Math.tan(THREE.MathUtils.degToRad(kFieldOfView / 2));
    const cosine = 1 / Math.hypot(1, half, half * this.camera.aspect);
    this.loader.load({eye: this.camera.position.toArray(), look: look.toArray(), cosine}).catch((error) => this.onError(error));
  }

  setShape(shape) {
    this.surface.setShape(shape);
    this.onDrawn(shape);
    this.draw();
    return new Promise((resolve) => { this.onTime = resolve; });
  }
  setMode(mode) {
    this.surface.uniforms.mode.value = mode;
    this.draw();
  }
  setPages(states) {
    this.surface.setPages(states);
    if (this.surface.uniforms.mode.value === 3) this.draw();
  }

  showAnswer(answer) {
    if (answer && this.info.instances) this.surface.uniforms.nearest.value = answer.instance ?? -1;
    const position = this.fromModel(this.probe.position);
    if (answer && answer.distance !== null)
      this.markers.answeredBy(position, this.fromModel(answer.point), answer.normal && new THREE.Vector3(...answer.normal),
                              answer.contacts.map((contact) => this.fromModel(contact.point)));
    else this.markers.movedTo(position);
    this.draw();
  }

  // Draws before the next frame of the screen, once.
  draw() {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      const distance = this.camera.position.distanceTo(this.middle);
      this.camera.near = Math.max(distance - 3 * this.radius, distance * 1e-3, this.radius * 1e-5);
      this.camera.far = distance + 20 * this.radius;
      this.camera.updateProjectionMatrix();
      this.markers.resize((position) => this.unitAt(position));
      const begin = performance.now();
      this.renderer.render(this.scene, this.camera);
      if (!this.onTime) return;
      // Reading a dot waits until all is drawn.
      const gl = this.renderer.getContext();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
      this.onTime(performance.now() - begin);
      this.onTime = null;
    });
  }

  // Length of a dot of the screen at a position of the scene.
  unitAt(position) {
    const half = Math.tan(THREE.MathUtils.degToRad(kFieldOfView / 2));
    return 2 * half * this.camera.position.distanceTo(position) / Math.max(1, this.stage.clientHeight);
  }

  // Where the probe is on the screen, in dots of the stage.
  screenOf(position) {
    const at = position.clone().project(this.camera);
    return [(at.x + 1) / 2 * this.stage.clientWidth, (1 - at.y) / 2 * this.stage.clientHeight];
  }

  isNear(event) {
    const box = this.stage.getBoundingClientRect();
    const [x, y] = this.screenOf(this.markers.probe.position);
    return Math.hypot(event.clientX - box.left - x, event.clientY - box.top - y) <= (kGrab[event.pointerType] ?? kGrab.mouse);
  }

  grab(event) {
    if (!event.isPrimary || event.button !== 0 || !this.isNear(event)) return;
    event.stopPropagation();
    this.held = event.pointerId;
    this.last = [event.clientX, event.clientY];
    this.stage.classList.add('holds');
    this.stage.focus({preventScroll: true});
    try { this.stage.setPointerCapture(event.pointerId); } catch { /* the pointer is gone */ }
  }

  point(event) {
    if (this.held !== event.pointerId) {
      this.stage.classList.toggle('near', this.isNear(event));
      return;
    }
    event.stopPropagation();
    this.moveProbe(event.clientX - this.last[0], this.last[1] - event.clientY, 0);
    this.last = [event.clientX, event.clientY];
  }

  release(event) {
    if (this.held !== event.pointerId) return;
    event.stopPropagation();
    this.held = null;
    this.stage.classList.remove('holds');
  }

  // Moves the probe by dots of the screen: right, up, and away from the eye.
  moveProbe(right, up, away) {
    const position = this.fromModel(this.probe.position);
    const unit = this.unitAt(position), axes = [0, 1, 2].map(() => new THREE.Vector3());
    this.camera.matrixWorld.extractBasis(...axes);
    position.addScaledVector(axes[0], right * unit).addScaledVector(axes[1], up * unit).addScaledVector(axes[2], -away * unit);
    this.probe.moveTo(this.toModel(position));
  }

  // Turns the camera about its target by radians, or moves it to a share of its distance.
  turn(aside, upward, share = 1) {
    const up = this.camera.up, isUpY = up.y === 1;
    const toY = new THREE.Quaternion().setFromUnitVectors(up, new THREE.Vector3(0, 1, 0));
    const off = this.camera.position.clone().sub(this.controls.target).applyQuaternion(toY);
    const place = new THREE.Spherical().setFromVector3(off);
    place.theta += aside;
    place.phi = THREE.MathUtils.clamp(place.phi - upward, 0.02, Math.PI - 0.02);
    place.radius *= share;
    off.setFromSpherical(place);
    if (!isUpY) off.applyQuaternion(toY.invert());
    this.isTurned = true;
    this.camera.position.copy(this.controls.target).add(off);
    this.controls.update();
    this.moved();
  }
}
