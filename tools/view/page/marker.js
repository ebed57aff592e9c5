// The probe, the nearest point with the line and the normal there, and contacts.

import * as THREE from './three.module.js';

const kMaxContacts = 16;

function ball(colour, options = {}) {
  return new THREE.Mesh(new THREE.SphereGeometry(1, 24, 16), new THREE.MeshBasicMaterial({color: colour, ...options}));
}

function line(colour) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(6), 3));
  const made = new THREE.Line(geometry, new THREE.LineBasicMaterial({color: colour}));
  made.frustumCulled = false;
  return made;
}

export class Markers {
  constructor(scene) {
    this.probe = ball(0);
    this.ghost = ball(0, {depthTest: false, transparent: true, opacity: 0.35});
    this.ghost.renderOrder = 1;
    this.nearest = ball(0);
    this.way = line(0);
    this.normal = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 1, 0);
    this.contacts = Array.from({length: kMaxContacts}, () => ball(0));
    this.answered = [this.nearest, this.way, this.normal];
    scene.add(this.probe, this.ghost, ...this.answered, ...this.contacts);
    for (const part of [...this.answered, ...this.contacts]) part.visible = false;
  }

  setColours(colourOf) {
    const [probe, nearest] = ['--probe', '--nearest'].map((name) => new THREE.Color().setRGB(...colourOf(name), THREE.SRGBColorSpace));
    for (const part of [this.probe, this.ghost, this.way]) part.material.color.copy(probe);
    for (const part of [this.nearest, ...this.contacts]) part.material.color.copy(nearest);
    this.normal.setColor(nearest);
  }

  movedTo(position) {
    this.probe.position.copy(position);
    this.ghost.position.copy(position);
    for (const part of [...this.answered, ...this.contacts]) part.visible = false;
  }

  // Vectors of the scene; normal is of length 1, or null if it is not known.
  answeredBy(position, nearest, normal, contacts) {
    this.movedTo(position);
    for (const part of this.answered) part.visible = true;
    this.nearest.position.copy(nearest);
    const ends = this.way.geometry.attributes.position;
    ends.setXYZ(0, ...position.toArray());
    ends.setXYZ(1, ...nearest.toArray());
    ends.needsUpdate = true;
    this.normal.position.copy(nearest);
    this.normal.visible = normal !== null;
    if (normal) this.normal.setDirection(normal);
    contacts.slice(0, kMaxContacts).forEach((point, i) => {
      this.contacts[i].position.copy(point);
      this.contacts[i].visible = true;
    });
  }

  // Keeps sizes on the screen the same. unitAt(position): length of a dot there.
  resize(unitAt) {
    this.probe.scale.setScalar(9 * unitAt(this.probe.position));
    this.ghost.scale.copy(this.probe.scale);
    this.nearest.scale.setScalar(5 * unitAt(this.nearest.position));
    for (const contact of this.contacts) contact.scale.setScalar(4 * unitAt(contact.position));
    const unit = unitAt(this.normal.position);
    this.normal.setLength(60 * unit, 14 * unit, 9 * unit);
  }
}
