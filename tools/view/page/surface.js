// The surface: discs that are clipped by their boxes, and triangles.

import * as THREE from './three.module.js';
import {colourOfInstance} from './instances.js';

export const kModes = {surface: 0, side: 1, level: 2, pages: 3, instance: 4};
const kPagesPerRow = 1024, kTexelsPerRow = 3072;  // the latter a multiple of 3 and of 4

// Discs and triangles are in textures, from which the vertices fetch them by their numbers: one
// piece of geometry for each disc would take four times as much memory, or an instance. Another
// texture has three texels for the place of each instance: rotation; offset and scale; colour.
const kFetch = `
uniform sampler2D pieces, places;
vec4 texel(sampler2D texels, int number) {
  return texelFetch(texels, ivec2(number % ${kTexelsPerRow}, number / ${kTexelsPerRow}), 0);
}
vec3 turned(vec3 at, int instance) {
  vec4 turn = texel(places, 3 * instance);
  return at + 2.0 * cross(turn.xyz, cross(turn.xyz, at) + turn.w * at);
}
vec3 placed(vec3 at, int instance) {
  vec4 move = texel(places, 3 * instance + 1);
  return move.xyz + move.w * turned(at, instance);
}
`;

const kColours = `${kFetch}
uniform int mode;
uniform float deepest;
uniform sampler2D pageStates;
uniform vec3 surfaceColour, frontColour, backColour;
uniform vec3 stateColours[4];
uniform int nearest;
uniform vec3 nearestColour;

vec3 ramp(float t) {
  const vec3 stops[5] = vec3[5](vec3(0.267, 0.005, 0.329), vec3(0.231, 0.322, 0.545),
    vec3(0.129, 0.568, 0.549), vec3(0.369, 0.788, 0.384), vec3(0.993, 0.906, 0.144));
  float at = clamp(t, 0.0, 1.0) * 4.0;
  int i = min(int(at), 3);
  return mix(stops[i], stops[i + 1], at - float(i));
}

// n points out of the front; toEye has length 1.
vec4 shaded(vec3 n, vec3 toEye, vec3 up, float page, float depth, int instance) {
  bool isFront = dot(n, toEye) >= 0.0;
  if (!isFront) n = -n;
  vec3 colour = surfaceColour;
  if (mode == 1) colour = isFront ? frontColour : backColour;
  if (mode == 2) colour = ramp((depth - 1.0) / max(1.0, deepest - 1.0));
  if (mode == 3) {
    int number = int(page + 0.5);
    ivec2 at = ivec2(number % ${kPagesPerRow}, number / ${kPagesPerRow});
    colour = stateColours[int(texelFetch(pageStates, at, 0).r * 255.0 + 0.5)];
  }
  if (mode == 4) colour = texel(places, 3 * instance + 2).rgb;
  if (instance == nearest && mode == 0) colour = mix(colour, nearestColour, 0.35);
  if (instance == nearest && mode == 4) colour = mix(colour, vec3(1.0), 0.3);
  float light = 0.30 + 0.50 * max(0.0, dot(n, normalize(toEye + 0.5 * up))) + 0.20 * (0.5 + 0.5 * dot(n, up));
  return vec4(colour * min(1.0, light * 1.08), 1.0);
}
`;

const kDiscVertex = `${kFetch}
out vec3 place, own;
flat out vec3 discAxis, lower, upper;
flat out vec4 middle;
flat out vec3 facts;
void main() {
  const vec2 corners[6] = vec2[6](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));
  int first = gl_VertexID / 6 * 4;
  vec4 disc = texel(pieces, first), axisAndPage = texel(pieces, first + 1), lowerAndDepth = texel(pieces, first + 2);
  vec3 axis = axisAndPage.xyz;
  vec2 corner = corners[gl_VertexID % 6];
  vec3 side = normalize(abs(axis.z) < 0.9 ? vec3(axis.y, -axis.x, 0.0) : vec3(0.0, axis.z, -axis.y));
  own = disc.xyz + disc.w * (corner.x * side + corner.y * cross(axis, side));
  float margin = 0.08 * disc.w;
  vec4 upperAndInstance = texel(pieces, first + 3);
  lower = lowerAndDepth.xyz - margin; upper = upperAndInstance.xyz + margin;
  middle = disc; facts = vec3(axisAndPage.w, lowerAndDepth.w, upperAndInstance.w);
  int instance = int(facts.z);
  place = placed(own, instance); discAxis = turned(axis, instance);
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}`;

const kDiscFragment = `${kColours}
in vec3 place, own;
flat in vec3 discAxis, lower, upper;
flat in vec4 middle;
flat in vec3 facts;
uniform vec3 up;
out vec4 colour;
void main() {
  vec3 off = own - middle.xyz;
  if (dot(off, off) > middle.w * middle.w) discard;
  if (any(lessThan(own, lower)) || any(greaterThan(own, upper))) discard;
  colour = shaded(discAxis, normalize(cameraPosition - place), up, facts.x, facts.y, int(facts.z));
}`;

const kTriangleVertex = `${kFetch}
out vec3 place;
flat out vec3 facts;
void main() {
  int first = gl_VertexID / 3 * 3;
  facts = vec3(texel(pieces, first).w, texel(pieces, first + 1).w, texel(pieces, first + 2).w);
  place = placed(texel(pieces, gl_VertexID).xyz, int(facts.z));
  gl_Position = projectionMatrix * viewMatrix * vec4(place, 1.0);
}`;

const kTriangleFragment = `${kColours}
in vec3 place;
flat in vec3 facts;
uniform vec3 up;
out vec4 colour;
void main() {
  vec3 toEye = normalize(cameraPosition - place);
  vec3 n = normalize(cross(dFdx(place), dFdy(place)));
  if ((dot(n, toEye) >= 0.0) != gl_FrontFacing) n = -n;
  colour = shaded(n, toEye, up, facts.x, facts.y, int(facts.z));
}`;

// A mesh whose vertices are fetched from a texture of its own.
function fetchedMesh(vertexShader, fragmentShader, uniforms) {
  const material = new THREE.ShaderMaterial({
    vertexShader, fragmentShader, uniforms: {...uniforms, pieces: {value: null}},
    glslVersion: THREE.GLSL3, side: THREE.DoubleSide});
  const geometry = new THREE.BufferGeometry();
  geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 1);
  geometry.setDrawRange(0, 0);
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  mesh.visible = false;
  return mesh;
}

// A texture of texels of four numbers.
function textureOf(data) {
  const rows = Math.ceil(data.length / 4 / kTexelsPerRow), floats = new Float32Array(4 * rows * kTexelsPerRow);
  floats.set(data);
  const texture = new THREE.DataTexture(floats, kTexelsPerRow, rows, THREE.RGBAFormat, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

function setPieces(mesh, data, vertices) {
  const uniform = mesh.material.uniforms.pieces;
  uniform.value?.dispose();
  mesh.visible = vertices > 0;
  mesh.geometry.setDrawRange(0, vertices);
  if (mesh.visible) uniform.value = textureOf(data);
}

// Three texels for the place of each instance. A model stands where it is.
function placesOf(instances) {
  if (!instances) return [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0];
  return instances.flatMap(({rotation: [w, x, y, z], offset, scale}, index) =>
    [x, y, z, w, ...offset, scale, ...colourOfInstance(index), 0]);
}

export class Surface {
  // instances: those of a scene, in the order of their numbers; undefined: a model
  constructor(scene, instances) {
    this.uniforms = {
      places: {value: textureOf(placesOf(instances))}, nearest: {value: -1}, nearestColour: {value: new THREE.Vector3()},
      mode: {value: 0}, deepest: {value: 1}, pageStates: {value: null}, up: {value: new THREE.Vector3(0, 1, 0)},
      surfaceColour: {value: new THREE.Vector3()}, frontColour: {value: new THREE.Vector3()},
      backColour: {value: new THREE.Vector3()},
      stateColours: {value: [0, 1, 2, 3].map(() => new THREE.Vector3())},
    };
    this.setPages(new Uint8Array(1));
    this.discs = fetchedMesh(kDiscVertex, kDiscFragment, this.uniforms);
    this.triangles = fetchedMesh(kTriangleVertex, kTriangleFragment, this.uniforms);
    scene.add(this.discs, this.triangles);
  }

  setShape(shape) {
    setPieces(this.discs, shape.discData, 6 * shape.discs);
    setPieces(this.triangles, shape.triangleData, 3 * shape.triangles);
    this.uniforms.deepest.value = shape.deepest;
  }

  setPages(states) {
    const rows = Math.max(1, Math.ceil(states.length / kPagesPerRow));
    const bytes = new Uint8Array(rows * kPagesPerRow);
    bytes.set(states);
    this.uniforms.pageStates.value?.dispose();
    const texture = new THREE.DataTexture(bytes, kPagesPerRow, rows, THREE.RedFormat, THREE.UnsignedByteType);
    texture.needsUpdate = true;
    this.uniforms.pageStates.value = texture;
  }

  // colours: functions from names of the style sheet to three numbers
  setColours(colourOf) {
    this.uniforms.surfaceColour.value.fromArray(colourOf('--surface'));
    this.uniforms.frontColour.value.fromArray(colourOf('--front'));
    this.uniforms.nearestColour.value.fromArray(colourOf('--nearest'));
    this.uniforms.backColour.value.fromArray(colourOf('--back'));
    ['--unread', '--resident', '--wanted', '--evicted'].forEach((name, i) => {
      this.uniforms.stateColours.value[i].fromArray(colourOf(name));
    });
  }
}
