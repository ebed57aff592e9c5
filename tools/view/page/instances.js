// The instances of a scene: their list, which one is nearest, and the memory of their models.

import {kibText} from './answer.js';

// What an instance is called on the page.
export const nameOf = (info, index) => info.instances[index].name || `${info.instances[index].model} #${index}`;

// A colour of each instance as three numbers, unlike those of its neighbours in the list.
export function colourOfInstance(index) {
  const hue = index * 137.508 % 360 / 60, parts = [5, 3, 1].map((at) => (at + hue) % 6);
  return parts.map((part) => 0.72 - 0.42 * Math.max(0, Math.min(part, 4 - part, 1)));
}

function cells(row, words) {
  for (const word of words) row.insertCell().textContent = word;
  return row;
}

export class InstancesPanel {
  // onShow(index): called when the reader wants to see an instance
  constructor(info, onShow) {
    this.info = info;
    const section = document.getElementById('instances');
    this.nearest = document.getElementById('nearest-instance');
    section.hidden = false;
    this.listInstances(section.querySelector('#instance-list tbody'), onShow);
    this.listModels(section.querySelector('#model-list tbody'));
  }

  listInstances(body, onShow) {
    const bytes = new Map(this.info.models.map((model) => [model.name, model.memory_bytes.total]));
    this.rows = this.info.instances.map((instance, index) => {
      const row = cells(body.insertRow(), ['', instance.model, kibText(bytes.get(instance.model))]);
      const button = document.createElement('button'), patch = document.createElement('span');
      patch.className = 'key';
      patch.style.background = `rgb(${colourOfInstance(index).map((part) => Math.round(255 * part)).join(' ')})`;
      button.type = 'button';
      button.textContent = nameOf(this.info, index);
      button.title = 'Move the probe and the view there';
      button.addEventListener('click', () => onShow(index));
      row.cells[0].append(patch, button);
      return row;
    });
  }

  listModels(body) {
    for (const model of this.info.models)
      cells(body.insertRow(), [`${model.name} × ${model.instances.toLocaleString('en-US')}`, model.triangles.toLocaleString('en-US'),
                               model.layers.join(', '), kibText(model.memory_bytes.total)]);
  }

  // Marks the instance of an answer; undefined: none.
  mark(index) {
    if (index === this.marked) return;
    this.rows[this.marked]?.removeAttribute('aria-current');
    this.rows[index]?.setAttribute('aria-current', 'true');
    this.marked = index;
    this.nearest.textContent = index === undefined ? 'none' : nameOf(this.info, index);
  }
}
