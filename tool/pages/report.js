// SPDX-License-Identifier: MIT
'use strict';
(() => {
  // ---- the history of another pixel ----
  const box = byId('follow');
  const command = box && byId('pixel-command').textContent.replace(/X,Y$/, '');
  function follow(pixel) {
    byId('pixel-command').textContent = command + pixel;
    box.hidden = false;
  }
  function followAndCopy(pixel) {
    if (!box) return;
    follow(pixel);
    box.querySelector('button').click();
  }
  function followLinked() {
    const linked = location.hash.match(/^#follow-(\d+,\d+)$/);
    if (!box || !linked) return;
    follow(linked[1]);
    box.scrollIntoView({block: 'center'});
  }
  for (const link of document.querySelectorAll('a[href^="#follow-"]'))
    link.addEventListener('click', () => followAndCopy(link.hash.slice('#follow-'.length)));
  addEventListener('hashchange', followLinked);
  followLinked();

  // ---- picture viewer: two pictures, one divider, shared zoom ----
  const stills = [...document.querySelectorAll('.strip img')];
  if (stills.length > 0) viewer();

  function viewer() {
    const canvas = byId('view'), stage = canvas.parentElement, split = byId('split');
    const context = canvas.getContext('2d');
    const state = {left: 0, right: Math.min(1, stills.length - 1), split: 0.5, scale: 1, x: 0, y: 0};
    const find = (role) => stills.findIndex((image) => image.dataset.role === role);
    if (find('before') >= 0) state.left = find('before');
    if (find('after') >= 0) state.right = find('after');
    // Mismatches are shown first.
    if (data.result.checks.mismatches > 0 && find('difference') >= 0) {
      state.left = find('after');
      state.right = find('difference');
      state.split = 0;
      split.value = '0';
    }
    const pixels = stills.map(() => null);
    // For a picture of a map: its scale, and its values once decoded.
    const maps = stills.map((image) => data.maps[image.dataset.role]);
    maps.filter(Boolean).forEach((map) => {
      map.image = new Image();
      map.image.src = map.source;
    });
    let pointed = null;  // pixel selected by pointer or keys
    let byKeys = false;

    for (const side of ['left', 'right']) {
      const select = byId(side);
      stills.forEach((image, i) => select.add(new Option(image.dataset.title, String(i))));
      select.value = String(state[side]);
      select.addEventListener('change', () => { state[side] = Number(select.value); changed(); });
    }
    stills.forEach((image, i) => {
      const show = () => {
        state.right = i;
        byId('right').value = String(i);
        changed();
      };
      image.tabIndex = 0;
      image.addEventListener('click', show);
      image.addEventListener('keydown', (event) => { if (event.key === 'Enter') show(); });
    });
    function changed() {
      drawScales();
      tell();
      draw();
    }
    split.addEventListener('input', () => { state.split = split.value / 1000; draw(); });

    // A picture of a map includes margins with its scale: these are cropped.
    const sizeOf = (i) => maps[i] ? {w: maps[i].width, h: maps[i].height}
                                  : {w: stills[i].naturalWidth, h: stills[i].naturalHeight};
    const size = () => sizeOf(state.left);
    const fitScale = () => canvas.width / size().w;
    const ratio = () => canvas.width / canvas.clientWidth;

    function resize() {
      const {w, h} = size();
      if (!w) return;
      // As wide as the picture, without margins.
      stage.style.maxWidth = split.style.maxWidth = `${Math.max(320, 620 * w / h)}px`;
      const width = Math.round(stage.clientWidth * devicePixelRatio);
      const height = Math.round(Math.min(
          Math.max(width * h / w, 160 * devicePixelRatio), 620 * devicePixelRatio));
      if (canvas.width !== width || canvas.height !== height) {
        canvas.width = width;
        canvas.height = height;
      }
      fit();
    }
    function fit() {
      const {w, h} = size();
      // Only the middle of a very narrow picture is shown, or it would vanish.
      const least = Math.min(24 * ratio() / Math.min(w, h), 8);
      state.scale = Math.max(Math.min(canvas.width / w, canvas.height / h), least);
      state.x = (canvas.width - w * state.scale) / 2;
      state.y = (canvas.height - h * state.scale) / 2;
      draw();
    }
    function zoomAt(factor, cx, cy) {
      const least = Math.min(fitScale(), canvas.height / size().h) / 2;
      const scale = Math.min(64, Math.max(least, state.scale * factor));
      state.x = cx - (cx - state.x) * scale / state.scale;
      state.y = cy - (cy - state.y) * scale / state.scale;
      state.scale = scale;
      draw();
    }
    function paint(i, from, to) {
      const {w, h} = sizeOf(i), at = [state.x, state.y, w * state.scale, h * state.scale];
      if (to <= from) return;
      context.save();
      context.beginPath();
      context.rect(from, 0, to - from, canvas.height);
      context.clip();
      context.imageSmoothingEnabled = state.scale < 1;
      context.imageSmoothingQuality = 'high';
      context.fillStyle = '#808080';  // background of transparent pixels
      context.fillRect(...at);
      context.drawImage(stills[i], 0, 0, w, h, ...at);
      context.restore();
    }
    function tag(text, x, align) {
      context.font = `${13 * ratio()}px system-ui, sans-serif`;
      const width = context.measureText(text).width + 16 * ratio(), height = 24 * ratio();
      const left = align === 'right' ? x - width : x;
      context.fillStyle = 'rgba(0, 0, 0, .62)';
      context.fillRect(left, 8 * ratio(), width, height);
      context.fillStyle = '#fff';
      context.textBaseline = 'middle';
      context.fillText(text, left + 8 * ratio(), 8 * ratio() + height / 2);
    }
    function draw() {
      const middle = Math.round(canvas.width * state.split);
      context.clearRect(0, 0, canvas.width, canvas.height);
      paint(state.left, 0, middle);
      paint(state.right, middle, canvas.width);
      context.fillStyle = '#fff';
      context.fillRect(middle - ratio(), 0, 2 * ratio(), canvas.height);
      context.fillStyle = 'rgba(0, 0, 0, .5)';
      context.fillRect(middle + ratio(), 0, ratio(), canvas.height);
      drawPointed();
      if (middle > 0) tag(stills[state.left].dataset.title, 8 * ratio(), 'left');
      if (middle < canvas.width) tag(stills[state.right].dataset.title, canvas.width - 8 * ratio(), 'right');
      const percent = state.scale / ratio() * 100;
      byId('zoom').textContent = percent < 1 ? '<1 %' : `${percent.toFixed(0)} %`;
    }
    function colour(index, x, y) {
      if (!pixels[index]) pixels[index] = readable(stills[index]);
      return [...pixels[index].getImageData(x, y, 1, 1).data].join(', ');
    }
    function readable(image) {
      const copy = document.createElement('canvas');
      copy.width = image.naturalWidth;
      copy.height = image.naturalHeight;
      const c = copy.getContext('2d', {willReadFrequently: true});
      c.drawImage(image, 0, 0);
      return c;
    }

    // ---- maps: value of a pixel, and its position on the scale ----------------------------------
    const digits = new Intl.NumberFormat('en-US', {maximumSignificantDigits: 6});
    const amount = (value) => Number.isInteger(value) ? number.format(value) : digits.format(value);
    function valueOf(map, pixel) {
      if (!pixel || pixel.x >= map.width || pixel.y >= map.height || !map.image.naturalWidth) return null;
      map.values ??= readable(map.image);
      const [r, g, b] = map.values.getImageData(pixel.x, pixel.y, 1, 1).data;
      const code = r << 16 | g << 8 | b;
      return code === 0 ? null : map.least + (code - 1) * map.step;
    }
    const share = (low, high, at) => high > low ? (at - low) / (high - low) : 0;
    const partOf = (map, value) => value <= map.knee
        ? map.knee_part * share(map.least, map.knee, value)
        : map.knee_part + (1 - map.knee_part) * share(map.knee, map.most, value);
    const gradient = `linear-gradient(to right, ${data.map_colours.map((c) => `rgb(${c.slice(0, 3)})`).join(', ')})`;
    function drawScales() {
      for (const side of ['left', 'right']) {
        const box = byId(`scale-${side}`), map = maps[state[side]];
        if (!box) return;
        box.hidden = !map;
        box.replaceChildren();
        if (!map) continue;
        element('b', `${side === 'left' ? 'Left' : 'Right'}: ${map.title}`, box);
        const bar = element('div', '', box, 'bar');
        bar.style.background = gradient;
        const value = valueOf(map, pointed);
        if (value !== null) element('i', '', bar, 'at').style.left = `${100 * partOf(map, value)}%`;
        const ends = element('div', '', box, 'ends');
        element('span', `least ${amount(map.least)} ${map.unit}`, ends);
        if (map.knee < map.most)
          element('span', `all but 0.5 % up to ${amount(map.knee)}, at ${(100 * map.knee_part).toFixed(1)} % of the scale`, ends);
        element('span', `most ${amount(map.most)} ${map.unit}`, ends);
      }
    }
    function words(index, pixel) {
      const map = maps[index], title = stills[index].dataset.title;
      if (!map)
        return `${title} RGBA ${colour(index, pixel.x, pixel.y)}`;
      const value = valueOf(map, pixel);
      return `${title} ${value === null ? 'has no value there' : `${amount(value)} ${map.unit}`}`;
    }
    function tell() {
      byId('probe').textContent = pointed
          ? `pixel (${pointed.x}, ${pointed.y})   left: ${words(state.left, pointed)}   right: ${words(state.right, pointed)}`
          : '';
    }
    function point(pixel) {
      pointed = pixel;
      tell();
      drawScales();
    }
    const frame = () => stills.reduce((least, _, i) => {
      const {w, h} = sizeOf(i);
      return {w: Math.min(least.w, w), h: Math.min(least.h, h)};
    }, {w: Infinity, h: Infinity});
    function drawPointed() {
      if (!pointed || !byKeys) return;
      const side = Math.max(state.scale, 7 * ratio());
      const x = state.x + (pointed.x + 0.5) * state.scale, y = state.y + (pointed.y + 0.5) * state.scale;
      for (const [width, style] of [[3, '#000'], [1.5, '#fff']]) {
        context.lineWidth = width * ratio();
        context.strokeStyle = style;
        context.strokeRect(x - side / 2, y - side / 2, side, side);
      }
    }
    canvas.addEventListener('keydown', (event) => {
      const step = event.shiftKey ? 10 : 1;
      const moves = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]};
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (moves[event.key]) {
        const {w, h} = frame(), [dx, dy] = moves[event.key];
        const from = pointed ?? {x: Math.floor(w / 2), y: Math.floor(h / 2)};
        byKeys = true;
        point({x: Math.min(w - 1, Math.max(0, from.x + dx)), y: Math.min(h - 1, Math.max(0, from.y + dy))});
        // Keeps it in view.
        const into = (origin, at, length) => {
          const here = origin + (at + 0.5) * state.scale;
          return origin + Math.min(0, 0.9 * length - here) + Math.max(0, 0.1 * length - here);
        };
        if (state.scale * w > canvas.width) state.x = into(state.x, pointed.x, canvas.width);
        if (state.scale * h > canvas.height) state.y = into(state.y, pointed.y, canvas.height);
        draw();
      } else if (event.key === '+' || event.key === '-') {
        const at = pointed ? [state.x + (pointed.x + 0.5) * state.scale, state.y + (pointed.y + 0.5) * state.scale]
                           : [canvas.width / 2, canvas.height / 2];
        zoomAt(event.key === '+' ? 2 : 0.5, ...at);
      } else if (event.key === 'Home') {
        fit();
      } else if (event.key === 'Enter' && pointed) {
        followAndCopy(`${pointed.x},${pointed.y}`);
      } else {
        return;
      }
      event.preventDefault();
    });

    const at = (event) => {
      const box = canvas.getBoundingClientRect();
      return {x: (event.clientX - box.left) * ratio(), y: (event.clientY - box.top) * ratio()};
    };
    const pixelAt = (p) => {
      const {w, h} = size();
      const x = Math.floor((p.x - state.x) / state.scale), y = Math.floor((p.y - state.y) / state.scale);
      return x >= 0 && y >= 0 && x < Math.min(w, frame().w) && y < Math.min(h, frame().h) ? {x, y} : null;
    };
    let drag = null;
    canvas.addEventListener('pointerdown', (event) => {
      const p = at(event);
      const near = Math.abs(p.x - canvas.width * state.split) < 10 * ratio();
      drag = {divider: near, x: p.x, y: p.y, from: p, moved: near};
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener('pointermove', (event) => {
      const p = at(event);
      if (drag && Math.hypot(p.x - drag.from.x, p.y - drag.from.y) > 4 * ratio()) drag.moved = true;
      if (drag && drag.divider) {
        state.split = Math.min(1, Math.max(0, p.x / canvas.width));
        split.value = String(Math.round(state.split * 1000));
        draw();
      } else if (drag) {
        state.x += p.x - drag.x;
        state.y += p.y - drag.y;
        drag.x = p.x;
        drag.y = p.y;
        draw();
      }
      const drawn = byKeys;
      byKeys = false;
      if (drawn) draw();
      point(pixelAt(p));
    });
    canvas.addEventListener('pointerup', (event) => {
      const pixel = drag && !drag.moved && pixelAt(at(event));
      if (pixel) followAndCopy(`${pixel.x},${pixel.y}`);
      drag = null;
    });
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      const p = at(event);
      zoomAt(event.deltaY < 0 ? 1.25 : 0.8, p.x, p.y);
    }, {passive: false});
    byId('zoom-in').addEventListener('click', () => zoomAt(2, canvas.width / 2, canvas.height / 2));
    byId('zoom-out').addEventListener('click', () => zoomAt(0.5, canvas.width / 2, canvas.height / 2));
    byId('fit').addEventListener('click', fit);
    addEventListener('resize', resize);
    const images = [...stills, ...maps.filter(Boolean).map((map) => map.image)];
    Promise.all(images.map((image) => image.decode().catch(() => {}))).then(() => { resize(); drawScales(); });
  }

  // ---- charts ----
  const stallColours = ['#d08a2c', '#b9503f', '#7c62a8', '#8b9138', '#b0608c', '#5c7fb5', '#9a7654',
                        '#4f8f6b', '#c9ab3a', '#72777e'];
  // One colour per cause, the same in all charts. After the first ten, each new colour is the farthest from all earlier
  // ones and from both tones of --busy, at lightnesses that are visible in the light and dark theme.
  const stallCauses = [...new Set(Object.values(data.result.units).flatMap((unit) =>
      Object.keys(unit.stalls).filter((cause) => unit.stalls[cause] > 0)))];
  const hex = (hue, lightness) => '#' + [0, 8, 4].map((offset) => {
    const turn = (offset + hue / 30) % 12;
    const part = lightness - 0.65 * Math.min(lightness, 1 - lightness) * Math.max(-1, Math.min(turn - 3, 9 - turn, 1));
    return Math.round(255 * part).toString(16).padStart(2, '0');
  }).join('');
  const distance = (a, b) => Math.hypot(...[1, 3, 5].map((i) => parseInt(a.slice(i, i + 2), 16) - parseInt(b.slice(i, i + 2), 16)));
  const causeColours = stallColours.slice(0, stallCauses.length);
  const others = [0.42, 0.54, 0.66].flatMap((lightness) => Array.from({length: 36}, (_, i) => hex(10 * i, lightness)));
  while (causeColours.length < stallCauses.length) {
    const nearest = (colour) => Math.min(...['#2b7a8f', '#4fa3b8', ...causeColours].map((taken) => distance(colour, taken)));
    causeColours.push(others.reduce((best, colour) => nearest(colour) > nearest(best) ? colour : best));
  }
  const colourOfCause = (cause) => causeColours[stallCauses.indexOf(cause)];
  let charts = [];

  // ---- sampling intervals -----------------------------------------------------------------------
  const intervals = data.intervals;
  const links = Object.entries(data.result.links || {});
  let chosen = -1;  // sampling interval
  if (intervals) {
    const units = byId('time-unit');
    for (const name of Object.keys(intervals.series.units)) units.add(new Option(name));
    const worst = (data.result.bottleneck || {}).unit;
    if (worst in intervals.series.units) units.value = worst;
    // FIFOs first, fullest first.
    const order = [...links].sort(([, a], [, b]) => (b.depth > 2) - (a.depth > 2) ||
        b.mean / b.depth - a.mean / a.depth);
    for (const [name, link] of order) byId('link').add(new Option(`${name}, depth ${link.depth}`, name));
    for (const select of [units, byId('link')]) select.addEventListener('change', drawCharts);
    const linked = () => Number((location.hash.match(/^#interval-(\d+)$/) || [])[1]);
    choose(linked() < intervals.from.length ? linked() : 0);
    addEventListener('hashchange', () => {
      if (!(linked() < intervals.from.length)) return;
      choose(linked());
      byId('interval-chosen').scrollIntoView({block: 'nearest'});
    });
  }
  function choose(window) {
    chosen = window;
    const from = intervals.from[window], to = from + intervals.cycles[window];
    byId('interval-chosen').textContent = `Interval ${window}: cycles ${number.format(from)} to ${number.format(to)}.`;
    byId('interval-command').textContent =
        `${intervals.command} --trace '*' --trace-from ${from} --trace-to ${to}`;
    for (const chart of charts) if (chart.options.overTime) chart.draw();
  }

  // Ticks of an axis with bins: bin i covers edges[i] to edges[i + 1] and is drawn at i. Only round numbers, as many as
  // fit.
  function roundTicks(edges) {
    const last = edges.length - 2;
    const placeOf = (value) => {
      let i = edges.findIndex((edge) => edge > value) - 1;
      if (i < 0) i = value < edges[0] ? 0 : last;
      return i - 0.5 + (value - edges[i]) / (edges[i + 1] - edges[i]);
    };
    // If all bins are one number wide, a tick labels the bin that starts there.
    const single = edges.every((edge, i) => i === 0 || edge === edges[i - 1] + 1);
    return {
      autoSkip: false,
      maxRotation: 0,
      callback: (_, i, ticks) => number.format(ticks[i].round),
      build(axis) {
        const from = edges[0], to = single ? edges[last] : edges[last + 1];
        const width = axis.maxWidth || axis.chart.width;
        const text = 7 * number.format(to).length + 22;
        const least = (to - from) * text / Math.max(width - 60, text);
        const power = 10 ** Math.floor(Math.log10(Math.max(least, 1)));
        const step = [1, 2, 5, 10].map((k) => k * power).find((k) => k >= least) ?? 10 * power;
        const ticks = [];
        for (let value = Math.ceil(from / step) * step; value <= to; value += step) {
          const at = placeOf(value) + (single ? 0.5 : 0), before = ticks[ticks.length - 1];
          // Bins differ in width: fewer ticks fit where they are dense.
          if (before && (at - before.value) * width / edges.length < text * 0.8) continue;
          ticks.push({value: at, round: value});
        }
        axis.ticks = ticks;
      }
    };
  }

  function drawCharts() {
    for (const chart of charts) chart.destroy();
    charts = [];
    chartColours();
    // The common prefix of all names, up to a '_'.
    const withoutBeginning = (names) => {
      let shared = names[0] ?? '';
      for (const name of names)
        while (!name.startsWith(shared)) shared = shared.slice(0, -1);
      const length = shared.lastIndexOf('_') + 1;
      return names.map((name) => name.slice(length));
    };
    // Cycles of each unit, by cause.
    const units = Object.entries(data.result.units);
    if (units.length > 0) {
      const cycles = ([, unit]) => unit.busy + unit.idle +
          Object.values(unit.stalls).reduce((a, b) => a + b, 0);
      const share = (count, unit) => cycles(unit) ? 100 * count / cycles(unit) : 0;
      const bars = (label, colour, get) => series(label, colour, units.map((unit) => share(get(unit[1]), unit)),
                                                  {counts: units.map((unit) => get(unit[1]))});
      charts.push(stackedBars('units', units.map(([name]) => name), [
        bars('busy', css('--busy'), (unit) => unit.busy),
        ...stallCauses.map((cause) => bars(`stalled: ${cause.replaceAll('_', ' ')}`, colourOfCause(cause),
                                           (unit) => unit.stalls[cause] || 0)),
        bars('idle', css('--idle'), (unit) => unit.idle)
      ], axis('% of cycles', {max: 100}), {tooltip: {callbacks: {label: (item) => `${item.dataset.label}: ` +
          `${number.format(item.dataset.counts[item.dataIndex])} clk (${item.raw.toFixed(1)} %)`}}}));
    }

    // Latency histogram with its percentiles as lines.
    const latency = data.result.latency, bins = latency.histogram;
    if (bins.length > 0 && byId('latency')) {
      // Equal percentiles share a line.
      const marks = [];
      for (const name of ['p50', 'p95', 'p99']) {
        const same = marks.find((mark) => mark[1] === latency[name]);
        if (same) same[0] += ` = ${name}`;
        else marks.push([name, latency[name]]);
      }
      const lines = {
        id: 'percentiles',
        afterDatasetsDraw(chart) {
          const {ctx, chartArea, scales} = chart;
          ctx.save();
          ctx.font = '11px system-ui, sans-serif';
          marks.forEach(([name, value], i) => {
            let bin = bins.findIndex((b, k) => k + 1 === bins.length || bins[k + 1].from > value);
            if (bin < 0) bin = bins.length - 1;
            const x = scales.x.getPixelForValue(bin);
            ctx.strokeStyle = ctx.fillStyle = css('--bad');
            ctx.setLineDash([4, 3]);
            ctx.beginPath();
            ctx.moveTo(x, chartArea.top + 14 * i + 4);
            ctx.lineTo(x, chartArea.bottom);
            ctx.stroke();
            const text = `${name} = ${number.format(value)}`;
            const width = ctx.measureText(text).width, right = x + 6 + width > chartArea.right;
            ctx.fillStyle = css('--card');  // keeps lines and bars from crossing the text
            ctx.fillRect(right ? x - 6 - width : x + 4, chartArea.top + 14 * i, width + 2, 14);
            ctx.fillStyle = css('--bad');
            ctx.textAlign = right ? 'right' : 'left';
            ctx.fillText(text, right ? x - 5 : x + 5, chartArea.top + 14 * i + 10);
          });
          ctx.restore();
        }
      };
      const latencyTicks = roundTicks([...bins.map((bin) => bin.from),
          Math.max(latency.max + 1, bins[bins.length - 1].from + 1)]);
      charts.push(new Chart(byId('latency'), {
        type: 'bar',
        data: {
          labels: bins.map((bin) => number.format(bin.from)),
          datasets: [{data: bins.map((bin) => bin.count), backgroundColor: css('--busy'),
                      categoryPercentage: 1, barPercentage: bins.length > 60 ? 1 : 0.92}]
        },
        options: {
          scales: {
            x: axis(`latency, ${latency.unit}`, {grid: {display: false}, ticks: latencyTicks, afterBuildTicks: latencyTicks.build}),
            y: axis('transactions', {beginAtZero: true})
          },
          plugins: {
            legend: {display: false},
            tooltip: {callbacks: {title: (items) => {
              const i = items[0].dataIndex;
              return i + 1 < bins.length && bins[i + 1].from > bins[i].from + 1
                  ? `${bins[i].from} to ${bins[i + 1].from - 1} clk` : `${bins[i].from} clk`;
            }}}
          }
        },
        plugins: [lines]
      }));
    }

    if (intervals) drawIntervals();

    // Memory bits: used at this frame's width, built for wider frames, and overhead of copies and padded banks.
    const memories = Object.entries(data.result.memories);
    if (memories.length > 0) {
      const here = memories.map(([, m]) => m.logical_bits_at_frame_width);
      const beyond = memories.map(([, m], i) => m.logical_bits - here[i]);
      const copied = memories.map(([, m]) => m.physical_bits - m.logical_bits);
      const wider = beyond.some((bits) => bits > 0);
      const copies = copied.some((bits) => bits > 0);
      // The table below shows full names; here the common prefix is dropped.
      charts.push(stackedBars('memories', withoutBeginning(memories.map(([name]) => name)), [
        series(wider ? 'at this width' : 'logical', css('--busy'), here),
        ...(wider ? [series('more, as built', css('--idle'), beyond)] : []),
        ...(copies ? [series('copies', css('--warn'), copied)] : [])
      ], axis('bits', {ticks: {maxRotation: 0, autoSkipPadding: 12}}), {legend: {...kLegend, display: wider || copies}}));
    }
  }

  // Charts over time share an axis and mark the selected interval.
  function drawIntervals() {
    const cycles = intervals.cycles;
    const labels = intervals.from.map((from) => number.format(from));
    const mark = {
      id: 'chosen',
      afterDatasetsDraw(chart) {
        const {ctx, chartArea, scales} = chart;
        const width = (chartArea.right - chartArea.left) / labels.length;
        ctx.save();
        ctx.strokeStyle = css('--ink');
        ctx.lineWidth = 1.5;
        ctx.strokeRect(scales.x.getPixelForValue(chosen) - Math.max(width, 3) / 2, chartArea.top,
                       Math.max(width, 3), chartArea.bottom - chartArea.top);
        ctx.restore();
      }
    };
    const lastWindow = labels.length - 1;
    const cycleTicks = roundTicks([...intervals.from, intervals.from[lastWindow] + cycles[lastWindow]]);
    const range = (i) => `cycles ${labels[i]} to ${number.format(intervals.from[i] + cycles[i])}`;
    const add = (id, type, datasets, y, more = {}) => charts.push(new Chart(byId(id), {
      type,
      data: {labels, datasets},
      options: {
        overTime: true,
        interaction: {mode: 'index', intersect: false},
        onClick(event, _, chart) {
          const i = Math.round(chart.scales.x.getValueForPixel(event.x));
          choose(Math.min(labels.length - 1, Math.max(0, i)));
        },
        scales: {
          x: axis('cycle', {offset: true, grid: {display: false}, stacked: more.stacked, ticks: cycleTicks,
                            afterBuildTicks: cycleTicks.build}),
          y: axis(y, {beginAtZero: true, stacked: more.stacked, max: more.max, suggestedMax: more.suggestedMax}),
          ...(more.scales || {})
        },
        plugins: {
          legend: kLegend,
          tooltip: {callbacks: {title: (items) => range(items[0].dataIndex)}}
        }
      },
      plugins: [mark]
    }));
    const colours = [css('--busy'), ...stallColours];
    const line = (label, colour, values, more) => series(label, colour, values, {
      borderWidth: 1.8, pointRadius: labels.length > 60 ? 0 : 2, stepped: 'middle', ...more
    });
    const bars = (label, colour, values) => series(label, colour, values, {categoryPercentage: 1, barPercentage: 1});
    const over = (values, by) => values.map((value, i) => value / by[i]);

    const rates = intervals.throughput.filter((rate) => rate.key.slice(5) in intervals.series.work);
    add('rate-time', 'line', rates.flatMap((rate, i) => [
      line(`${rate.label}, ${rate.unit}`, colours[i], over(intervals.series.work[rate.key.slice(5)], cycles)),
      ...(rate.bound > 0 ? [line(`bound ${rate.bound} ${rate.unit}`, colours[i],
          labels.map(() => rate.bound),
          {borderDash: [5, 4], borderWidth: 1, pointRadius: 0, backgroundColor: 'transparent'})] : [])
    ]), 'throughput');

    const unit = intervals.series.units[byId('time-unit').value];
    const share = (values) => over(values, cycles).map((value) => 100 * value);
    const causes = Object.entries(unit.stalls || {}).filter(([, values]) => values.some((v) => v > 0));
    add('unit-time', 'bar', [
      bars('busy', css('--busy'), share(unit.busy)),
      ...causes.map(([cause, values]) => bars(`stalled: ${cause.replaceAll('_', ' ')}`,
          colourOfCause(cause), share(values))),
      bars('idle', css('--idle'), share(unit.idle))
    ], '% of cycles', {stacked: true, max: 100});

    const ports = Object.entries(intervals.series.ports || {});
    if (ports.length > 0)
      add('port-time', 'line', ports.flatMap(([name, port], i) => [
        line(`${name}: in flight, mean`, colours[3 * i % colours.length], over(port.outstanding, cycles)),
        ...[['read', '_bytes_read'], ['written', '_bytes_written']]
            .map(([what, key], k) => [what, intervals.series.work[name + key], k])
            .filter(([, bytes]) => bytes && bytes.some((b) => b > 0))
            .map(([what, bytes, k]) => line(`${name}: ${what}, byte/clk`,
                colours[(3 * i + 1 + k) % colours.length], over(bytes, cycles), {yAxisID: 'bytes'}))
      ]), 'transactions', {scales: {bytes: axis(['byte/clk', `100: ${(data.result.clock_mhz / 10).toFixed(1)} GB/s`],
                                                {beginAtZero: true, position: 'right', grid: {display: false}})}});

    if (links.length === 0) return;
    const name = byId('link').value, link = data.result.links[name], watched = intervals.series.links[name];
    add('link-time', 'line', [
      line('mean', css('--busy'), over(watched.occupancy, cycles)),
      line('maximum', css('--warn'), watched.most)
    ], 'beats', {suggestedMax: link.depth});
    const total = link.histogram.reduce((a, b) => a + b, 0);
    const beatTicks = roundTicks([...link.histogram.map((_, i) => i), link.histogram.length]);
    charts.push(new Chart(byId('link-histogram'), {
      type: 'bar',
      data: {labels: link.histogram.map((_, i) => i),
             datasets: [bars('cycles', css('--busy'), link.histogram.map((count) => 100 * count / total))]},
      options: {
        scales: {
          x: axis(`beats inside, of ${link.depth}`, {grid: {display: false}, ticks: beatTicks, afterBuildTicks: beatTicks.build}),
          y: axis('% of cycles', {beginAtZero: true})
        },
        plugins: {
          legend: {display: false},
          tooltip: {callbacks: {label: (item) => `${number.format(link.histogram[item.dataIndex])} clk (${item.raw.toFixed(2)} %)`}}
        }
      }
    }));
  }
  drawCharts();
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', drawCharts);
})();
