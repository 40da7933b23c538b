// What the colours mean.
import { make } from './dom.js';

function patch({ color, hatch, label }) {
  const box = make('span', { class: hatch ? 'patch hatch' : 'patch', style: color ? `background:${color}` : '' });
  return make('span', { class: 'key-patch' }, box, label);
}

export function legend(description) {
  if (!description) return [];
  const parts = [make('p', { class: 'legend-title' }, description.title)];
  if (description.gradient) {
    const bar = make('div', { class: 'bar-scale', style: `background:linear-gradient(to right,${description.gradient})` });
    if (description.mark) bar.append(make('i', { style: `left:${100 * description.mark}%` }));
    const ticks = make('div', { class: 'ticks' });
    for (const { at, label } of description.ticks) {
      ticks.append(make('span', { style: `left:${100 * at}%` }, label));
    }
    parts.push(make('div', { class: 'scale' }, bar, ticks));
  }
  parts.push(make('div', { class: 'patches' }, ...description.patches.map(patch)));
  return parts;
}
