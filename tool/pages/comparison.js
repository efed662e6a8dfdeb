// SPDX-License-Identifier: MIT
// Pictures with a shared zoom, or fronts and points of sweeps.
'use strict';
(() => {
  if (data.kind === 'runs') showPictures(); else showSweeps();

  // ---- runs ----
  function showPictures() {
    const select = byId('role');
    if (!select) return;
    const roles = [...document.querySelectorAll('.role')];
    const all = () => [...document.querySelectorAll('.window img')];
    let zoom = 1, x = 0, y = 0;  // x, y: the left and upper edge as fractions of the picture
    function place() {
      for (const image of all()) image.style.transform = `scale(${zoom}) translate(${-100 * x}%, ${-100 * y}%)`;
    }
    function choose() {
      for (const role of roles) role.classList.toggle('chosen', role.dataset.role === select.value);
      showDifferences();
    }
    select.addEventListener('change', choose);
    for (const frame of document.querySelectorAll('.window')) {
      frame.addEventListener('wheel', (event) => {
        event.preventDefault();
        const box = frame.getBoundingClientRect();
        const px = (event.clientX - box.left) / box.width, py = (event.clientY - box.top) / box.height;
        const at = [x + px / zoom, y + py / zoom];
        zoom = Math.min(32, Math.max(1, zoom * (event.deltaY < 0 ? 1.25 : 0.8)));
        x = Math.min(1 - 1 / zoom, Math.max(0, at[0] - px / zoom));
        y = Math.min(1 - 1 / zoom, Math.max(0, at[1] - py / zoom));
        place();
      }, {passive: false});
      frame.addEventListener('dblclick', () => { zoom = 1; x = y = 0; place(); });
    }

    // Shows every picture after the first of its role as its difference from the first.
    const kGain = 8;
    function pixels(image) {
      const canvas = document.createElement('canvas');
      canvas.width = image.naturalWidth;
      canvas.height = image.naturalHeight;
      const context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, canvas.width, canvas.height);
    }
    async function showDifferences() {
      const role = roles.find((r) => r.dataset.role === select.value);
      const images = [...role.querySelectorAll('img')];
      for (const image of images) {
        image.dataset.own ??= image.src;
        image.src = image.dataset.own;
      }
      if (!byId('against').checked || images.length < 2) return;
      await Promise.all(images.map((image) => image.decode()));
      const base = pixels(images[0]);
      for (const image of images.slice(1)) {
        const other = pixels(image);
        if (other.width !== base.width || other.height !== base.height) continue;
        for (let i = 0; i < base.data.length; ++i)
          if (i % 4 !== 3) other.data[i] = Math.min(255, kGain * Math.abs(other.data[i] - base.data[i]));
        const canvas = document.createElement('canvas');
        canvas.width = base.width;
        canvas.height = base.height;
        canvas.getContext('2d').putImageData(other, 0, 0);
        image.src = canvas.toDataURL();
      }
    }
    byId('against').addEventListener('change', showDifferences);
    choose();
  }

  // ---- sweeps ----
  function showSweeps() {
    const kMostRows = 1000;
    const ink = css('--ink');
    const palette = [css('--accent'), '#c2571a', '#3a8f5c', '#8a5fb0', '#b08a1e', '#b33a6b', '#4a7f8f', '#7a6a58'];
    const names = data.sweeps.map((s) => s.name);
    for (const badge of document.querySelectorAll('.letter'))
      badge.style.background = palette[names.indexOf(badge.textContent) % palette.length];
    const metrics = data.metrics;
    const finite = (v) => Number.isFinite(v);
    const shownOr = (v) => shown(v, '-');
    const titled = (m) => m.unit ? `${m.name} (${m.unit})` : m.name;
    const decibels = (m) => m.unit === 'dB';
    const every = [...data.points, ...data.only];
    // JSON cannot represent infinity: identical pictures are flagged next to their values.
    for (const p of every)
      p.values.forEach((values, s) => metrics.forEach((m, i) => {
        if (p.identical[s].includes(m.name)) values[i] = Infinity;
      }));
    // An axis with a single value is omitted.
    const axes = data.axes.map((name, i) => ({name, i}))
      .filter((axis) => new Set(every.map((p) => p.at[axis.i])).size > 1);
    const numeric = new Intl.Collator('en', {numeric: true});
    for (const points of [data.points, data.only])
      points.sort((p, q) => axes.reduce((order, axis) => order || numeric.compare(p.at[axis.i], q.at[axis.i]), 0));
    const short = (name) => name.split('.').slice(-2).join('.');
    const placeOf = (p) => axes.map((axis) => `${axis.name} = ${p.at[axis.i]}`);

    const goals = data.objectives.map((name) => metrics.findIndex((m) => m.name === name));
    for (const [id, first] of [['across', goals[0] ?? 0], ['up', goals[1] ?? Math.min(1, metrics.length - 1)]]) {
      metrics.forEach((m, i) => byId(id).add(new Option(titled(m), i)));
      byId(id).value = first;
      byId(id).addEventListener('change', drawScatter);
    }
    byId('front-only').addEventListener('change', drawScatter);
    // Points that are not dominated in the two displayed metrics, from left to right.
    function staircase(points, mx, my) {
      const sign = (m) => m.maximise === true ? -1 : 1;
      if (mx.maximise === null || my.maximise === null) return [];
      const order = [...points].sort((a, b) => sign(mx) * (a.x - b.x) || sign(my) * (a.y - b.y));
      const best = [];
      for (const p of order)
        if (best.length === 0 || sign(my) * p.y < sign(my) * best[best.length - 1].y) best.push(p);
      return best;
    }
    function drawScatter() {
      const ix = Number(byId('across').value), iy = Number(byId('up').value);
      const only = byId('front-only').checked, sets = [];
      const place = (i) => placer(every.flatMap((p) => p.values.filter(Boolean).map((v) => v[i])));
      const across = place(ix), up = place(iy);
      names.forEach((name, s) => {
        const points = every.filter((p) => p.values[s] && p.values[s][ix] !== null && p.values[s][iy] !== null)
          .map((p) => ({x: across(p.values[s][ix]), y: up(p.values[s][iy]), point: p, sweep: s, front: p.front[s]}));
        const drawn = only ? points.filter((p) => p.front) : points;
        const tint = palette[s % palette.length];
        sets.push({
          type: 'line', data: staircase(points, metrics[ix], metrics[iy]), borderColor: tint, borderWidth: 1.5,
          pointRadius: 0, pointHitRadius: 0, label: '', stepped: false,
        });
        sets.push({
          label: `${name}: ${data.sweeps[s].sweep}`, data: drawn,
          backgroundColor: drawn.map((p) => tint + (p.front ? '' : '90')), borderColor: ink,
          borderWidth: drawn.map((p) => p.front ? 1 : 0), pointRadius: drawn.map((p) => p.front ? 6 : 3),
          pointStyle: ['circle', 'rect', 'triangle', 'rectRot'][s % 4],
        });
      });
      const coloured = (chart) => Chart.defaults.plugins.legend.labels.generateLabels(chart)
        .map((l) => ({...l, fillStyle: palette[((l.datasetIndex - 1) / 2) % palette.length]}));
      scatterOf('scatter', sets, [titled(metrics[ix]), shownOr], [titled(metrics[iy]), shownOr],
                {labels: {boxWidth: 12, usePointStyle: true, filter: (item) => item.text !== '', generateLabels: coloured}},
                ({dataset, raw: {point: p, sweep}}) => p
                  ? [dataset.label, `${metrics[ix].name} ${shownOr(p.values[sweep][ix])}, ` +
                     `${metrics[iy].name} ${shownOr(p.values[sweep][iy])}`, ...placeOf(p)] : '');
    }

    // ---- tables ----
    const change = (m, a, b) => {
      if (!finite(a) || !finite(b) || a === b) return '';
      const by = decibels(m) ? b - a : a === 0 ? NaN : 100 * (b - a) / Math.abs(a);
      return Number.isFinite(by) ? `${by < 0 ? '−' : '+'}${Math.abs(by).toFixed(2)} ${decibels(m) ? 'dB' : '%'}` : '';
    };
    function drawMatched() {
      const head = byId('matched').tHead, body = byId('matched').tBodies[0];
      head.replaceChildren();
      body.replaceChildren();
      const titles = element('tr', undefined, head);
      for (const axis of axes) element('th', short(axis.name), titles).title = axis.name;
      for (const m of metrics)
        for (const name of names) element('th', name === names[0] ? `${titled(m)}: ${name}` : name, titles, 'n').title = m.meaning;
      const which = byId('which').value;
      const points = data.points.filter((p) => which === 'all' || (which === 'worse' && p.worse) ||
        (which === 'front' && p.front.some(Boolean)) ||
        (which === 'different' && p.values.some((values) => values.some((v, i) => v !== p.values[0][i]))));
      for (const p of points.slice(0, kMostRows)) {
        const row = element('tr', undefined, body);
        for (const axis of axes) element('td', p.at[axis.i], row);
        metrics.forEach((m, i) => names.forEach((_, s) => {
          const checked = s === 0 ? '' : p.judgements[s - 1][i];
          const cell = element('td', shownOr(p.values[s][i]), row, `n ${checked}${checked === 'worse' && m.counts ? ' fails' : ''}`);
          if (s > 0) element('small', change(m, p.values[0][i], p.values[s][i]), cell);
        }));
      }
      byId('matched-shown').textContent = `${points.length} of ${data.points.length} points` +
        (points.length > kMostRows ? `, the first ${kMostRows} are shown` : '') +
        '. Green is better and red is worse than A, bold where it counts.';
    }
    function drawOnly() {
      if (!byId('only')) return;
      const head = element('tr', undefined, byId('only').tHead), body = byId('only').tBodies[0];
      for (const axis of axes) element('th', short(axis.name), head).title = axis.name;
      element('th', 'Sweep', head);
      for (const m of metrics) element('th', titled(m), head, 'n');
      element('th', 'Elsewhere', head);
      let count = 0;
      for (const p of data.only) {
        const there = names.map((_, s) => s).filter((s) => p.values[s]);
        const missing = names.map((name, s) => p.states[s] === 'done' ? '' : `${name}: ${p.states[s] === 'none' ? 'not in it' : p.states[s]}`)
          .filter(Boolean).join('; ');
        for (const s of there.length > 0 ? there : [null]) {
          if (++count > kMostRows) break;
          const row = element('tr', undefined, body);
          for (const axis of axes) element('td', p.at[axis.i], row);
          element('td', s === null ? '-' : names[s] + (p.front[s] ? ', on its front' : ''), row);
          metrics.forEach((_, i) => element('td', s === null ? '-' : shownOr(p.values[s][i]), row, 'n'));
          element('td', missing, row, p.worse ? 'worse' : 'muted');
        }
      }
      if (count > kMostRows) byId('only-shown').textContent = `The first ${kMostRows} are shown.`;
    }
    byId('which').addEventListener('change', drawMatched);
    drawScatter();
    drawMatched();
    drawOnly();
  }
})();
