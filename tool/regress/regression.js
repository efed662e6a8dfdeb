// SPDX-License-Identifier: MIT
'use strict';
(() => {
  const {features, trend} = data;
  const bars = (key, colour) => series(key, css(colour), features.map((feature) => feature[key]));
  stackedBars('rates', features.map((feature) => feature.id),
              [bars('passed', '--good'), bars('failed', '--bad'), bars('missing', '--idle')], {ticks: {precision: 0}});
  if (trend.length < 2) return;
  const line = (key, label, colour, yAxisID) => series(label, css(colour), trend.map((night) => night[key]),
                                                       {yAxisID, borderWidth: 1.5, pointRadius: 2.5});
  new Chart(byId('trend'), {
    type: 'line',
    data: {
      labels: trend.map((night) => night.date),
      datasets: [line('passed', 'pass rate', '--good', 'rate'), line('met', 'bins met', '--accent', 'rate'),
                 line('speed', 'speed', '--muted', 'speed')],
    },
    options: {
      plugins: {legend: kLegend},
      scales: {
        rate: axis('%', {position: 'left', max: 100}),
        speed: axis('thousand cycles per second', {position: 'right', beginAtZero: true, grid: {drawOnChartArea: false}}),
      },
    },
  });
})();
