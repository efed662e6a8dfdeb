// SPDX-License-Identifier: MIT
'use strict';
(() => {
  const features = JSON.parse(document.getElementById('data').textContent);
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
})();
