// SPDX-License-Identifier: MIT
'use strict';
(() => {
  const {features, trend} = JSON.parse(document.getElementById('data').textContent);
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue(name).trim();

  for (const command of document.querySelectorAll('.command'))
    copies(command.querySelector('button'), command.querySelector('pre'));

  document.getElementById('rates-frame').style.height = `${60 + 22 * features.length}px`;
  Chart.defaults.color = colour('--muted');
  Chart.defaults.borderColor = colour('--rule');
  const bars = (key, label, fill) =>
    ({label, data: features.map((feature) => feature[key]), backgroundColor: fill});
  new Chart(document.getElementById('rates'), {
    type: 'bar',
    data: {
      labels: features.map((feature) => feature.id),
      datasets: [bars('passed', 'passed', colour('--good')), bars('failed', 'failed', colour('--bad')),
                 bars('missing', 'missing', colour('--idle'))],
    },
    options: {
      indexAxis: 'y', animation: false, maintainAspectRatio: false,
      scales: {x: {stacked: true, beginAtZero: true, ticks: {precision: 0}}, y: {stacked: true}},
    },
  });

  if (trend.length < 2) return;
  const line = (key, label, stroke, axis) =>
    ({label, data: trend.map((night) => night[key]), borderColor: stroke, backgroundColor: stroke, yAxisID: axis,
      borderWidth: 1.5, pointRadius: 2.5, tension: 0});
  new Chart(document.getElementById('trend'), {
    type: 'line',
    data: {
      labels: trend.map((night) => night.date),
      datasets: [line('passed', 'pass rate', colour('--good'), 'rate'), line('met', 'bins met', colour('--accent'), 'rate'),
                 line('speed', 'speed', colour('--muted'), 'speed')],
    },
    options: {
      animation: false, maintainAspectRatio: false,
      scales: {
        rate: {position: 'left', max: 100, title: {display: true, text: '%'}},
        speed: {position: 'right', beginAtZero: true, grid: {drawOnChartArea: false},
                title: {display: true, text: 'thousand clocks a second'}},
      },
    },
  });
})();
