// SPDX-License-Identifier: MIT
'use strict';
(() => {
  const ink = css('--ink'), muted = css('--muted'), rule = css('--rule'), accent = css('--accent');
  const kMostRows = 200, kMostLines = 3000;

  // A column is an axis or a metric of all points.
  const isNumber = (text) => text !== '' && Number.isFinite(Number(text));
  const columns = [
    ...data.axes.map((axis, i) => {
      const labels = [...new Set([...axis.labels, ...data.points.map((p) => p.at[i])])];
      const numeric = labels.every(isNumber);
      return {name: axis.name, axis: i, numeric, labels, text: (p) => p.at[i], unit: '',
              value: (p) => numeric ? Number(p.at[i]) : labels.indexOf(p.at[i])};
    }),
    ...data.metrics.map((metric, i) => ({
      name: metric.name, metric: i, numeric: true, unit: metric.unit, meaning: metric.meaning,
      value: (p) => valueOf(p, i) ?? NaN,
      text: (p) => noValue(p, i) ? 'none' : shown(valueOf(p, i)),
      reason: (p) => noValue(p, i) ?? '',
    })),
  ];
  // JSON cannot represent infinity: identical pictures are flagged next to their values.
  function valueOf(p, i) {
    return p.identical?.includes(data.metrics[i].name) ? Infinity : p.values[i];
  }
  // Why a finished point lacks a metric.
  const noValue = (p, i) => p.no_value?.[data.metrics[i].name];
  const columnOf = (name) => columns.find((c) => c.name === name);
  const titled = (c) => c.unit ? `${c.name} (${c.unit})` : c.name;
  const done = data.points.filter((p) => p.state === 'done');

  // ---- one point ----
  const quoted = (word) =>
    /^[A-Za-z0-9_\-./=,:+@%]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
  function commandOf(p) {
    const settings = [...data.base];
    data.axes.forEach((axis, i) => {
      if (axis.conditional && p.at[i] === '-') return;
      const values = Object.keys(axis.choices).length > 0 ? axis.choices[p.at[i]] : [p.at[i]];
      axis.parameters.forEach((name, k) => settings.push([name, values[k]]));
    });
    return `deburr run ${data.engine}` + settings.map(([n, v]) => ' --set ' + quoted(`${n}=${v}`)).join('');
  }
  const directoryOf = (p) => `${data.points_directory}/${p.name.slice(0, 2)}/${p.name}`;
  const filesOf = [...(data.reports ? ['report.html'] : []), 'result.json', 'manifest.json'];
  let chosen = null;
  function choose(p) {
    chosen = p;
    const box = byId('chosen');
    box.replaceChildren();
    box.className = '';
    element('p', data.axes.map((a, i) => `${a.name} = ${p.at[i]}`).join(', '), box);
    element('p', p.state === 'done'
      ? data.metrics.map((m, i) => noValue(p, i) ? `${m.name} none (${noValue(p, i)})`
                                                 : `${m.name} ${shown(valueOf(p, i))} ${m.unit}`.trim()).join(', ')
      : `${p.state}${p.failure ? ': ' + p.failure : ''}`, box);
    const pre = element('pre', commandOf(p), box, 'code');
    pre.style.whiteSpace = 'pre-wrap';
    const links = element('p', '', box);
    for (const name of p.state === 'done' ? filesOf : []) {
      const link = element('a', name, links);
      link.href = `${directoryOf(p)}/${name}`;
      links.append(' ');
    }
    drawTable();
  }

  // ---- scatter ----
  const palette = ['#2b7a8f', '#b3362b', '#96650f', '#1f7a4d', '#7a4d9f', '#26588a', '#8f5a2b', '#5c6b2b'];
  function fill(select, options, value) {
    for (const column of options) select.add(new Option(titled(column), column.name));
    select.value = value;
    select.addEventListener('change', drawScatter);
  }
  const goals = data.objectives.map((o) => o.metric);
  const limits = data.limits ?? [];
  const metrics = columns.filter((c) => c.metric !== undefined);
  fill(byId('across'), columns, goals[0] ?? metrics[0].name);
  fill(byId('up'), columns, goals[1] ?? (metrics[1] ?? metrics[0]).name);
  fill(byId('colour'), columns.filter((c) => c.axis !== undefined), columns[0].name);
  byId('objectives').textContent = data.objectives.length === 0 ? '' : 'Objectives: ' +
    data.objectives.map((o) => `${o.maximise ? 'maximise' : 'minimise'} ${o.metric}`).join(', ') +
    (data.for_each.length > 0 ? `, a front for each ${data.for_each.join(', ')}` : '') +
    (limits.length > 0 ? `; limits: ${limits.join(', ')}` : '');
  // One front for each combination of the for_each axes, named by what distinguishes them.
  const frontAxes = data.for_each.map((name) => data.axes.findIndex((axis) => axis.name === name));
  const fronts = new Map();
  for (const p of done.filter((q) => q.front)) {
    const where = frontAxes.map((i) => `${data.axes[i].name} = ${p.at[i]}`).join(', ');
    if (!fronts.has(where)) fronts.set(where, []);
    fronts.get(where).push(p);
  }
  if (fronts.size > 1)
    byId('fronts').textContent = 'Fronts: ' +
      [...fronts].map(([where, points]) => `${where}: ${points.length}`).join('; ') + ' points.';
  const dashes = [[], [7, 4], [2, 3], [9, 3, 2, 3]];
  function linesOfFronts(x, y, across, up, colour, groups) {
    if (!goals.includes(x.name) || !goals.includes(y.name) || x === y) return [];
    const same = frontAxes.length === 1 && frontAxes[0] === colour.axis;
    const cost = (c, p) => c.value(p) * (data.objectives.find((o) => o.metric === c.name).maximise ? -1 : 1);
    // With further objectives, only the points that are best in these two.
    const best = (points) => {
      let least = Infinity;
      return points.sort((a, b) => cost(x, a) - cost(x, b) || cost(y, a) - cost(y, b))
        .filter((p) => cost(y, p) < least && ((least = cost(y, p)), true));
    };
    return [...fronts].map(([where, points], i) => ({
      label: `front${where === '' ? '' : ' of ' + where}`,
      data: best([...points]).map((p) => ({x: across(p), y: up(p), point: p})),
      showLine: true, pointRadius: 0, pointHitRadius: 0, borderWidth: 1.5,
      borderColor: same ? palette[groups.indexOf(points[0].at[colour.axis])] ?? ink : ink,
      backgroundColor: 'transparent', borderDash: same ? [] : dashes[i % dashes.length],
    }));
  }
  function drawScatter() {
    const x = columnOf(byId('across').value), y = columnOf(byId('up').value);
    const colour = columnOf(byId('colour').value);
    const groups = colour.labels.length <= palette.length ? colour.labels : [];
    const place = (column) => {
      const at = placer(done.map(column.value));
      return (p) => at(column.value(p));
    };
    const across = place(x), up = place(y);
    const sets = (groups.length > 0 ? groups : [null]).map((label, i) => {
      const points = done.filter((p) => label === null || p.at[colour.axis] === label)
        .filter((p) => !Number.isNaN(x.value(p)) && !Number.isNaN(y.value(p)));
      return {
        label: label === null ? 'all points' : `${colour.name} = ${label}`,
        data: points.map((p) => ({x: across(p), y: up(p), point: p})),
        backgroundColor: points.map((p) => palette[i] + (p.front || goals.length === 0 ? '' : '90')),
        borderColor: points.map((p) => p.beyond ? palette[i] : ink),
        borderWidth: points.map((p) => p.beyond ? 1.5 : p.front ? 1 : 0),
        pointRadius: points.map((p) => p.front ? 6 : p.beyond ? 4 : 3),
        pointStyle: points.map((p) => p.beyond ? 'crossRot' : 'circle'),
      };
    });
    const missing = done.filter((p) => Number.isNaN(x.value(p)) || Number.isNaN(y.value(p))).length;
    byId('not-drawn').textContent = missing === 0 ? '' :
      `Not drawn: ${missing} of ${done.length} points, which have no value here.`;
    const lines = linesOfFronts(x, y, across, up, colour, groups);
    sets.push(...lines);
    const scale = (column) => [titled(column), (v) => column.numeric ? shown(v) : column.labels[v] ?? ''];
    scatterOf('scatter', sets, scale(x), scale(y), {display: groups.length > 1 || lines.length > 1, labels: {boxWidth: 12}},
              ({raw: {point: p}}) => [`${x.name} ${x.text(p)}, ${y.name} ${y.text(p)}`,
                                      ...data.axes.map((a, i) => `${a.name} = ${p.at[i]}`)],
              (_, items) => {
                if (items.length > 0) choose(sets[items[0].datasetIndex].data[items[0].index].point);
              });
  }

  // ---- main effects ----
  const effectSelect = byId('effect-metric');
  for (const metric of metrics) effectSelect.add(new Option(titled(metric), metric.name));
  let effectCharts = [];
  function drawEffects() {
    const name = effectSelect.value;
    byId('effect-meaning').textContent = columnOf(name).meaning ?? '';
    effectCharts.forEach((c) => c.destroy());
    effectCharts = [];
    byId('effects').replaceChildren();
    const effects = data.effects.filter((e) => e.metric === name);
    // A common scale makes axes comparable.
    const all = effects.flatMap((e) => e.means.map((m) => m[1]));
    const low = Math.min(...all), high = Math.max(...all), margin = (high - low) * 0.08 || 1;
    if (effects.length === 0)
      element('p', 'None: no axis has two values with points that have this metric.',
              byId('effects'), 'muted');
    for (const effect of effects) {
      const box = element('div', undefined, byId('effects'));
      const means = effect.means.map((m) => m[1]);
      const most = Math.max(...means), least = Math.min(...means);
      const span = most - least > 1e-12 * Math.max(Math.abs(most), Math.abs(least)) ? most - least : 0;  // not rounding
      element('h3', `${effect.axis}, span ${shown(span)} ${columnOf(name).unit}`, box);
      const frame = element('div', undefined, box, 'chart');
      frame.style.height = '150px';
      const canvas = element('canvas', undefined, frame);
      canvas.setAttribute('role', 'img');
      canvas.setAttribute('aria-label', `Mean of ${name} by ${effect.axis}: ` +
          effect.means.map(([label, mean]) => `${label}: ${shown(mean)}`).join(', '));
      effectCharts.push(new Chart(canvas, {
        type: 'line',
        data: {labels: effect.means.map((m) => m[0]), datasets: [series(name, accent, means)]},
        options: {plugins: {legend: {display: false}},
                  scales: {y: {min: low - margin, max: high + margin,
                               ticks: {maxTicksLimit: 6, includeBounds: false, callback: (v) => shown(v)}}}},
      }));
    }
  }
  effectSelect.addEventListener('change', drawEffects);

  // ---- filters and table ----
  const filters = new Map();  // axis -> label
  const kStates = ['done', 'failed', 'missing', 'running'];
  let onlyFront = false, onlyWithin = false, states = new Set(kStates);
  let sortBy = null, descending = false;
  const bar = byId('filters');
  function filter(name, values, act) {
    const select = element('select', undefined, element('label', name + ' ', bar));
    for (const value of ['', ...values]) select.add(new Option(value || 'all', value));
    select.addEventListener('change', () => { act(select.value); drawTable(); drawParallel(); });
  }
  for (const column of columns.filter((c) => c.axis !== undefined && c.labels.length > 1 && c.labels.length <= 100))
    filter(column.name, column.labels, (value) => {
      if (value === '') filters.delete(column.axis); else filters.set(column.axis, value);
    });
  filter('state', kStates, (value) => { states = new Set(value === '' ? kStates : [value]); });
  function only(name, act) {
    const label = element('label', undefined, bar), box = element('input', undefined, label);
    box.type = 'checkbox';
    label.append(` ${name} only`);
    box.addEventListener('change', () => { act(box.checked); drawTable(); drawParallel(); });
    return label;
  }
  if (goals.length > 0) only('front', (checked) => { onlyFront = checked; });
  if (limits.length > 0) only('within limits', (checked) => { onlyWithin = checked; }).title = limits.join(', ');
  const passing = () => data.points.filter((p) => states.has(p.state) && (!onlyFront || p.front) &&
    (!onlyWithin || (p.state === 'done' && !p.beyond)) &&
    [...filters].every(([axis, label]) => p.at[axis] === label));

  function drawTable() {
    const head = byId('table').tHead, body = byId('table').tBodies[0];
    head.replaceChildren();
    body.replaceChildren();
    const titles = element('tr', undefined, head);
    for (const column of columns) {
      const cell = element('th', titled(column) + (sortBy === column ? (descending ? ' ▾' : ' ▴') : ''), titles,
                           'sort' + (column.metric !== undefined ? ' n' : ''));
      cell.title = column.meaning ?? '';
      pressable(cell, () => {
        descending = sortBy === column && !descending;
        sortBy = column;
        drawTable();
      });
    }
    element('th', 'Point', titles);
    const points = passing();
    if (sortBy) points.sort((a, b) => {
      const x = sortBy.value(a), y = sortBy.value(b);
      if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y);
      return (x < y ? -1 : x > y ? 1 : 0) * (descending ? -1 : 1);
    });
    for (const p of points.slice(0, kMostRows)) {
      const row = element('tr', undefined, body,
                          (p.front ? 'front ' : '') + (p.beyond ? 'beyond ' : '') + (p.state === 'failed' ? 'failed ' : '') + (p === chosen ? 'chosen' : ''));
      for (const column of columns) {
        const cell = element('td', column.text(p), row, column.metric !== undefined ? 'n' : '');
        if (column.reason?.(p)) cell.title = column.reason(p);
      }
      const last = element('td', undefined, row);
      if (p.beyond) row.title = `beyond the limit ${p.beyond}`;
      if (p.state === 'done') element('a', p.name.slice(0, 8), last).href = `${directoryOf(p)}/${filesOf[0]}`;
      else element('span', p.failure ? `${p.state}: ${p.failure}` : p.state, last);
      pressable(row, () => choose(p));
    }
    byId('shown').textContent = `${points.length} of ${data.points.length} points` +
      (points.length > kMostRows ? `, the first ${kMostRows} are shown` : '') + '; a click on a row, or Enter, shows its command.';
  }

  // ---- parallel coordinates ----
  function drawParallel() {
    const canvas = byId('parallel'), ratio = window.devicePixelRatio || 1;
    // Constant columns are omitted.
    const used = columns.filter((c) => c.axis !== undefined ? c.labels.length > 1
                                                            : new Set(done.map(c.value)).size > 1);
    canvas.style.minWidth = `${80 * used.length}px`;  // room for the labels of each
    const width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    const context = canvas.getContext('2d');
    context.scale(ratio, ratio);
    context.clearRect(0, 0, width, height);
    const top = 40, bottom = height - 26, left = 50, right = width - 50;
    const at = (i) => used.length > 1 ? left + (right - left) * i / (used.length - 1) : (left + right) / 2;
    const ranges = used.map((c) => {
      let low = Infinity, high = -Infinity;
      for (const p of done) {
        const v = c.value(p);
        if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
      }
      return high >= low ? [low, high > low ? high : low + 1] : [0, 1];
    });
    const level = (i, p) => {
      const v = used[i].value(p), [low, high] = ranges[i];
      if (Number.isNaN(v)) return null;
      // Values of an axis at equal distances.
      if (used[i].axis !== undefined && used[i].labels.length <= 30) {
        const order = used[i].numeric ? [...used[i].labels].sort((a, b) => a - b) : used[i].labels;
        return bottom - (bottom - top) * order.indexOf(p.at[used[i].axis]) / (order.length - 1);
      }
      return bottom - (bottom - top) * Math.min(1, (v - low) / (high - low));
    };
    const points = passing().filter((p) => p.state === 'done');
    const step = Math.max(1, Math.ceil(points.length / kMostLines));
    const some = points.filter((p, i) => p.front || i % step === 0);
    for (const front of [false, true]) {
      context.strokeStyle = front ? accent : muted;
      context.globalAlpha = front ? 0.9 : Math.max(0.06, Math.min(0.5, 30 / some.length));
      context.lineWidth = front ? 1.4 : 1;
      for (const p of some.filter((q) => Boolean(q.front) === front)) {
        context.beginPath();
        let begun = false;
        used.forEach((_, i) => {
          const y = level(i, p);
          if (y === null) { begun = false; return; }
          if (begun) context.lineTo(at(i), y); else context.moveTo(at(i), y);
          begun = true;
        });
        context.stroke();
      }
    }
    context.globalAlpha = 1;
    context.font = '11px system-ui, sans-serif';
    used.forEach((column, i) => {
      context.strokeStyle = rule;
      context.beginPath();
      context.moveTo(at(i), top);
      context.lineTo(at(i), bottom);
      context.stroke();
      context.fillStyle = ink;
      context.textAlign = i === 0 ? 'left' : i === used.length - 1 ? 'right' : 'center';
      const x = i === 0 ? 2 : i === used.length - 1 ? width - 2 : at(i);
      const short = column.name.split('.').slice(-2).join('.');
      context.fillText(short, x, i % 2 === 0 ? 12 : 25);
      context.fillStyle = muted;
      const ends = column.axis !== undefined && !column.numeric
        ? [column.labels[0], column.labels[column.labels.length - 1]] : ranges[i].map(shown);
      context.fillText(ends[0], x, bottom + 14);
      context.fillText(ends[1], x, top - 2);
    });
  }

  drawScatter();
  drawEffects();
  drawTable();
  drawParallel();
  window.addEventListener('resize', drawParallel);
})();
