// SPDX-License-Identifier: MIT
// A chart grows with the rows of its legend, so that what it draws keeps its height on a phone too.
'use strict';
(() => {
  const legends = Chart.defaults.plugins.legend;
  legends.maxHeight = 1e4;  // by itself a legend ends where half of the chart is used up
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
})();
