// The answer at the probe as text.

import {needsPages} from './probe.js';

const kSpokenMs = 600, kContactRows = 5;

// A number with as many digits as are worth reading.
export function text(value, digits = 7) {
  if (value === null || value === undefined) return 'unbounded';
  if (value === 0) return '0';
  const size = Math.abs(value);
  return size < 1e-4 || size >= 1e9 ? value.toExponential(digits - 1) : String(Number(value.toPrecision(digits)));
}

export const kibText = (bytes) => bytes < 1048576 ? `${(bytes / 1024).toFixed(1)} KiB` : `${(bytes / 1048576).toFixed(1)} MiB`;

export const triple = (vector, digits) => vector.map((value) => text(value, digits)).join(', ');

const kSides = {inside: 'inside', outside: 'outside', on_surface: 'on the surface', unknown: 'side not known'};
const sideText = (side) => kSides[side] ?? String(side).replaceAll('_', ' ');

function statusText(answer, isFinal) {
  if (answer.status === 'exact') return 'exact';
  if (!needsPages(answer)) return answer.status.replaceAll('_', ' ');
  return isFinal ? 'degraded' : 'degraded: pages are being read';
}

// Puts terms and descriptions into a list, without making elements anew.
export function fill(list, rows) {
  while (list.children.length > 2 * rows.length) list.lastChild.remove();
  rows.forEach(([term, description], i) => {
    if (!list.children[2 * i]) list.append(document.createElement('dt'), document.createElement('dd'));
    const [name, value] = [list.children[2 * i], list.children[2 * i + 1]];
    if (name.textContent !== term) name.textContent = term;
    if (value.textContent !== description) value.textContent = description;
  });
}

function table(contacts, nameOf) {
  const element = document.createElement('table');
  element.createCaption().textContent = contacts.length > kContactRows ? `The nearest ${kContactRows} contacts` : 'Contacts';
  const head = element.createTHead().insertRow();
  for (const word of ['distance', nameOf ? 'instance' : 'triangle', 'status']) {
    const cell = document.createElement('th');
    cell.scope = 'col';
    cell.textContent = word;
    head.append(cell);
  }
  const body = element.createTBody();
  for (const contact of contacts.slice(0, kContactRows)) {
    const row = body.insertRow();
    const place = nameOf ? nameOf(contact.instance) : contact.triangle ?? 'none';
    for (const word of [text(contact.distance), place, contact.status])
      row.insertCell().textContent = word;
  }
  return element;
}

export class AnswerPanel {
  // nameOf(index): the name of an instance; null: answers are of a model
  constructor(nameOf) {
    this.nameOf = nameOf;
    this.list = document.getElementById('answer');
    this.spoken = document.getElementById('spoken');
    this.contacts = document.getElementById('contacts');
    this.timer = 0;
  }

  show(answer, isFinal) {
    const instance = this.nameOf && answer.instance !== undefined ? this.nameOf(answer.instance) : null;
    const width = answer.upper === null ? null : answer.upper - answer.lower;
    fill(this.list, [
      ...(instance === null ? [] : [['instance', instance]]),
      ['distance', text(answer.distance, 10)],
      ['interval', `[${text(answer.lower, 10)}, ${text(answer.upper, 10)}]`],
      ['its width', text(width, 3)],
      ['side', sideText(answer.side)],
      ['normal', answer.normal === null ? 'not known' : triple(answer.normal, 5)],
      ['nearest point', triple(answer.point, 8)],
      ['triangle', answer.triangle === null ? 'none' : `${answer.triangle}, at its ${answer.feature}`],
      ['status', statusText(answer, isFinal)],
      ['contacts', `${answer.contacts.length}${answer.contacts_complete ? '' : ' or more'} within ${text(answer.contacts_within, 4)}`],
    ]);
    this.contacts.replaceChildren(...(answer.contacts.length > 0 ? [table(answer.contacts, this.nameOf)] : []));
    this.say(`${sideText(answer.side)}, ${text(answer.distance, 5)} from the surface${instance === null ? '' : ` of ${instance}`}; ` +
             `certainly between ${text(answer.lower, 5)} and ${text(answer.upper, 5)}; ` +
             `${answer.status.replaceAll('_', ' ')}.`);
  }

  // Not for every step of a drag, which would be read out for minutes.
  say(sentence) {
    clearTimeout(this.timer);
    const words = sentence[0].toUpperCase() + sentence.slice(1);
    this.timer = setTimeout(() => { if (this.spoken.textContent !== words) this.spoken.textContent = words; }, kSpokenMs);
  }
}
