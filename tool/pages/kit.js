// SPDX-License-Identifier: MIT
// Shared by the scripts of all pages: elements, copied commands, numbers, charts.
'use strict';
const data = JSON.parse(document.getElementById('data').textContent);
const byId = (id) => document.getElementById(id);
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const number = new Intl.NumberFormat('en-US');
const fiveDigits = new Intl.NumberFormat('en-US', {maximumSignificantDigits: 5});
function shown(value, none = '') {
  if (value === null || value === undefined) return none;
  if (typeof value === 'string') return value;
  if (value === Infinity) return 'identical';
  return Number.isInteger(value) || Math.abs(value) >= 1e4 ? number.format(Math.round(value)) : fiveDigits.format(value);
}
function element(tag, text, parent, className) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  parent?.append(made);
  return made;
}
// Activated by a click, or by Enter with keyboard focus.
function pressable(item, act) {
  item.tabIndex = 0;
  item.addEventListener('click', act);
  item.addEventListener('keydown', (event) => { if (event.key === 'Enter') act(); });
}
for (const command of document.querySelectorAll('.command:has(button)')) {
  const button = command.querySelector('button'), pre = command.querySelector('pre');
  button.addEventListener('click', async () => {
    try {
      await navigator.clipboard.writeText(pre.textContent);
    } catch (_) {  // a page from file:// may not be allowed to
      getSelection().selectAllChildren(pre);
      document.execCommand('copy');
    }
    button.textContent = 'Copied';
    setTimeout(() => { button.textContent = 'Copy'; }, 1500);
  });
}

// ---- charts ----
const kLegend = {position: 'bottom', labels: {boxWidth: 12}};
const axis = (text, more) => ({title: {display: true, text}, ...more});
const series = (label, colour, values, more) =>
    ({label, data: values, borderColor: colour, backgroundColor: colour, ...more});
function chartColours() {
  Chart.defaults.color = css('--muted');
  Chart.defaults.borderColor = css('--rule');
}
if (typeof Chart !== 'undefined') {
  chartColours();
  Object.assign(Chart.defaults, {animation: false, locale: 'en-US', maintainAspectRatio: false});
  Chart.defaults.font.family = 'system-ui, "DejaVu Sans", sans-serif';
  // A chart grows with its legend, so that the plot keeps its height on a phone too.
  Chart.defaults.plugins.legend.maxHeight = 1e4;  // by default a legend is cut off at half of the chart
  Chart.register({
    id: 'growing',
    beforeInit(chart) {
      const box = chart.canvas.parentElement;
      box.dataset.height ??= parseFloat(box.style.height);
    },
    afterLayout(chart) {
      const box = chart.canvas.parentElement, legend = chart.legend;
      const rows = legend?.options.display ? legend.lineWidths?.length ?? 1 : 1;
      const row = Chart.defaults.font.size + (legend?.options.labels.padding ?? 0);
      const height = `${Number(box.dataset.height) + Math.max(0, rows - 1) * row}px`;
      if (box.style.height !== height) box.style.height = height;
    },
  });
}
// One bar per name, from left to right. In a narrow chart names are split after a '_'.
function stackedBars(id, names, datasets, x, more = {}) {
  const canvas = byId(id), box = canvas.parentElement;
  const linesOf = (name, width) => {
    if (width > 600) return [name];
    const lines = [''], room = width > 400 ? 30 : 18;
    for (const part of name.split(/(?<=_)/)) {
      if (lines[lines.length - 1] !== '' && (lines[lines.length - 1] + part).length > room) lines.push('');
      lines[lines.length - 1] += part;
    }
    return lines;
  };
  const most = Math.max(1, ...names.map((name) => linesOf(name, box.clientWidth).length));
  box.style.height = `${Math.max(90, names.length * Math.max(30, 15 * most + 4) + 70)}px`;
  return new Chart(canvas, {
    type: 'bar',
    data: {labels: names, datasets: datasets.map((each) => ({maxBarThickness: 22, ...each}))},
    options: {
      indexAxis: 'y',
      scales: {
        x: {stacked: true, beginAtZero: true, ...x},
        y: {stacked: true, grid: {display: false}, ticks: {
          autoSkip: false,
          callback(value) { return linesOf(this.getLabelForValue(value), this.chart.width); },
        }},
      },
      plugins: {legend: kLegend, ...more},
    },
  });
}
// Positions of scatter values: identical pictures are placed beyond all numbers.
function placer(values) {
  const numbers = values.filter(Number.isFinite);
  const low = Math.min(...numbers), high = Math.max(...numbers);
  const beyond = numbers.length > 0 ? high + ((high - low) * 0.08 || 1) : 1;
  return (value) => value === Infinity ? beyond : value;
}
function scatterOf(id, datasets, x, y, legend, label, onClick) {
  const scale = ([text, callback]) => ({title: {display: true, text, color: css('--ink')}, ticks: {callback}});
  Chart.getChart(byId(id))?.destroy();
  return new Chart(byId(id), {
    type: 'scatter',
    data: {datasets},
    options: {onClick, scales: {x: scale(x), y: scale(y)}, plugins: {legend, tooltip: {callbacks: {label}}}},
  });
}
