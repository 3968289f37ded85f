// A volume in a page: slices, histogram, and its cells in space. Values are 16-bit floats times 2^-exponent.
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const form = document.querySelector(".controls").elements;
  const byId = (id) => document.getElementById(id);
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const figure = (v) => (Number.isFinite(v) ? String(Number(v.toPrecision(4))) : String(v));
  const NONE = 0, NUMBER = 1, NO_NUMBER = 2;  // what a cell holds
  const LUMINANCE = [0.2126, 0.7152, 0.0722];
  const RIGHT_AND_VERTICAL = [[2, 1, -1], [0, 2, 1], [0, 1, -1]];  // of a slice across x, y, z; -1: rows from the top down

  // --- values -------------------------------------------------------------------------------------------------------

  function halves(text, exponent) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const bits = new Uint16Array(bytes.buffer);
    const scale = 2 ** -exponent;
    const values = new Float32Array(bits.length), held = new Uint8Array(bits.length);
    for (let i = 0; i < bits.length; ++i) {
      const h = bits[i], e = (h >> 10) & 31, m = h & 1023, sign = h & 0x8000 ? -1 : 1;
      if (h === 0xfe00) continue;
      held[i] = e === 31 ? NO_NUMBER : NUMBER;
      values[i] = e === 31 ? NaN : sign * scale * (e === 0 ? m * 2 ** -24 : (1 + m / 1024) * 2 ** (e - 15));
    }
    return { values, held };
  }

  const decoded = new Map();
  const valuesOf = (grid) => {
    if (!decoded.has(grid)) decoded.set(grid, halves(grid.values, grid.exponent));
    return decoded.get(grid);
  };

  const SH = ["sh_00", "sh_1m1", "sh_10", "sh_11", "sh_2m2", "sh_2m1", "sh_20", "sh_21", "sh_22"];
  const bands = SH.map((name) => data.grids.find((grid) => grid.name === name)).filter(Boolean);
  const grids = [...data.grids];
  const alike = bands.every((b) => b.cells.join() === bands[0].cells.join() && b.first.join() === bands[0].first.join());
  if (bands.length >= 4 && alike)
    grids.push({ ...bands[0], name: "radiance", description: "by direction, from the spherical harmonics", kind: "colour",
      unit: bands[0].unit, values: null });

  const basis = ([x, y, z]) => {
    const a = 0.5 / Math.sqrt(Math.PI), b = Math.sqrt(3) * a, c = Math.sqrt(15) * a;
    return [a, b * y, b * z, b * x, c * x * y, c * y * z, Math.sqrt(5) * a * (1.5 * z * z - 0.5), c * x * z, 0.5 * c * (x * x - y * y)];
  };
  function towards() {
    const azimuth = form.azimuth.value * Math.PI / 180, height = form.height.value * Math.PI / 180;
    return [Math.cos(height) * Math.sin(azimuth), Math.sin(height), -Math.cos(height) * Math.cos(azimuth)];
  }
  function radiance() {
    const y = basis(towards()), parts = bands.map(valuesOf);
    const values = new Float32Array(parts[0].values.length);
    parts.forEach((part, k) => { for (let i = 0; i < values.length; ++i) values[i] += y[k] * part.values[i]; });
    for (let i = 0; i < values.length; ++i) values[i] = Math.max(values[i], 0);
    return { values, held: parts[0].held };
  }

  // --- what is shown ------------------------------------------------------------------------------------------------

  const state = { grid: null, cell: [0, 0, 0], field: null, scalar: null, turn: 0.7, tilt: 0.5, zoom: 1 };
  const at = ([x, y, z]) => x + state.grid.cells[0] * (y + state.grid.cells[1] * z);
  const channels = () => (state.grid.kind === "number" ? 1 : 3);

  function chooseGrid() {
    const before = state.grid;
    state.grid = grids[form.grid.selectedIndex];
    const names = state.grid.kind === "number" ? ["value"]
      : state.grid.kind === "normal" ? ["all", "x", "y", "z"] : ["all", "luminance", "red", "green", "blue"];
    form.channel.replaceChildren(...names.map((name) => new Option(name, name)));
    document.querySelector(".direction").hidden = state.grid.values !== null;
    const kept = before && before.cells.join() === state.grid.cells.join();
    if (!kept) state.cell = state.grid.cells.map((n) => Math.floor(n / 2));
    buildSlices();
    takeField(true);
  }

  function takeField(withRange) {
    state.field = state.grid.values === null ? radiance() : valuesOf(state.grid);
    form.direction.value = state.grid.values === null ? towards().map((v) => v.toFixed(2)).join(", ") : "";
    takeScalar(withRange);
  }

  /// The number of each cell that map, histogram and space go by: of "all" its luminance, of a normal its first component.
  function takeScalar(withRange) {
    const n = channels(), count = state.field.values.length / n, name = form.channel.value;
    const scalar = new Float32Array(count), held = new Uint8Array(count);
    const one = { value: 0, red: 0, green: 1, blue: 2, x: 0, y: 1, z: 2 }[name] ?? (state.grid.kind === "normal" ? 0 : -1);
    for (let i = 0; i < count; ++i) {
      held[i] = state.field.held[n * i];
      for (let c = 0; c < n; ++c) if (state.field.held[n * i + c] === NO_NUMBER) held[i] = NO_NUMBER;
      const v = state.field.values;
      scalar[i] = one >= 0 ? v[n * i + one] : LUMINANCE[0] * v[n * i] + LUMINANCE[1] * v[n * i + 1] + LUMINANCE[2] * v[n * i + 2];
    }
    state.scalar = { scalar, held };
    const numbers = scalar.filter((_, i) => held[i] === NUMBER).sort();
    state.stats = { count: numbers.length, low: numbers[0] ?? 0, high: numbers.at(-1) ?? 0,
      mean: numbers.reduce((sum, v) => sum + v, 0) / Math.max(numbers.length, 1), most: numbers[Math.floor(0.995 * numbers.length)] ?? 0 };
    const all = name === "all";
    if (withRange) {
      form.map.value = all ? "colour" : state.stats.low < 0 ? "diverging" : "viridis";
      const spread = state.stats.high > 4 * state.stats.most && state.stats.most > 0 ? state.stats.most : state.stats.high;
      setRange(Math.min(state.stats.low, 0), spread);
    }
    form.map.options[3].disabled = !all;
    if (!all && form.map.value === "colour") form.map.value = "viridis";
    draw();
  }

  function setRange(low, high) {
    form.low.value = figure(low);
    form.high.value = figure(high > low ? high : low + 1);
  }
  const range = () => {
    const low = Number(form.low.value), high = Number(form.high.value);
    return Number.isFinite(low) && Number.isFinite(high) && high > low ? [low, high] : [0, 1];
  };

  // --- colours ------------------------------------------------------------------------------------------------------

  const clamp = (v) => Math.min(Math.max(v, 0), 1);
  function viridis(t) {  // a fit by M. Zucker (CC0), as shaders/shared/color_maps.shared.h has it
    const k = [[-5.4354558559, 4.6458526122, 26.3124352496], [4.7763849977, -13.7451453777, -65.3530326334],
      [6.2282699363, 14.1799333668, 56.6905526007], [-4.6342304990, -5.7991009734, -19.3324409563],
      [-0.3308618287, 0.2148475595, 0.0950951630], [0.1050930431, 1.4046135299, 1.3845901626], [0.2777273272, 0.0054073445, 0.3340998053]];
    return [0, 1, 2].map((c) => 255 * clamp(k.reduce((sum, row) => sum * t + row[c], 0)));
  }
  const BLUE_TO_RED = [[5, 48, 97], [67, 147, 195], [247, 247, 247], [214, 96, 77], [103, 0, 31]];
  function diverging(t) {
    const x = t * 4, i = Math.min(Math.floor(x), 3);
    return [0, 1, 2].map((c) => BLUE_TO_RED[i][c] + (x - i) * (BLUE_TO_RED[i + 1][c] - BLUE_TO_RED[i][c]));
  }
  const srgb = (v) => (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);
  const table = (map) => Array.from({ length: 256 }, (_, i) =>
    (map === "grey" ? [i, i, i] : map === "diverging" ? diverging(i / 255) : viridis(i / 255)));

  function placeIn(v, [low, high]) {
    if (!form.log.checked) return clamp((v - low) / (high - low));
    const least = Math.max(low, high * 1e-4);
    return high > least ? clamp(Math.log(Math.max(v, least) / least) / Math.log(high / least)) : 0;
  }

  /// Of every cell: [r, g, b] by its index.
  function painter() {
    const [low, high] = form.map.value === "diverging" ? symmetric() : range(), map = form.map.value;
    const colours = map === "colour" ? null : table(map), none = hex(css("--none"));
    const { scalar, held } = state.scalar, v = state.field.values;
    return (i) => {
      if (held[i] === NONE) return none;
      if (held[i] === NO_NUMBER) return [255, 0, 255];
      if (colours) return colours[Math.round(255 * placeIn(scalar[i], [low, high]))];
      if (state.grid.kind === "normal") return [0, 1, 2].map((c) => 255 * clamp(0.5 + 0.5 * v[3 * i + c]));
      return [0, 1, 2].map((c) => 255 * srgb(placeIn(v[3 * i + c], [low, high])));
    };
  }
  const symmetric = () => { const end = Math.max(...range().map(Math.abs)); return [-end, end]; };
  const hex = (text) => [1, 3, 5].map((k) => parseInt(text.slice(k, k + 2), 16));

  // --- slices -------------------------------------------------------------------------------------------------------

  let slices = [];
  function buildSlices() {
    slices = [0, 1, 2].map((axis) => {
      const [right, vertical] = RIGHT_AND_VERTICAL[axis], n = state.grid.cells;
      const scale = Math.max(1, Math.floor(480 / Math.max(n[right], n[vertical])));
      const canvas = Object.assign(document.createElement("canvas"), { width: n[right] * scale, height: n[vertical] * scale, tabIndex: 0 });
      canvas.setAttribute("role", "application");
      const slider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: n[axis] - 1, name: "xyz"[axis] });
      const caption = document.createElement("figcaption"), box = document.createElement("figure");
      box.append(canvas, caption, slider);
      slider.setAttribute("aria-label", `slice across ${"xyz"[axis]}`);
      slider.addEventListener("input", () => { state.cell[axis] = Number(slider.value); draw(); });
      canvas.addEventListener("keydown", (event) => key(event, axis));
      const point = (event) => {
        if (event.type === "pointermove" && event.buttons === 0) return;
        const area = canvas.getBoundingClientRect();
        fromPlace(axis, (event.clientX - area.left) / area.width, (event.clientY - area.top) / area.height);
      };
      canvas.addEventListener("pointerdown", point);
      canvas.addEventListener("pointermove", point);
      return { axis, canvas, slider, caption, box, scale };
    });
    byId("slices").replaceChildren(...slices.map((s) => s.box));
  }

  function fromPlace(axis, u, v) {
    const [right, vertical, way] = RIGHT_AND_VERTICAL[axis], n = state.grid.cells;
    const within = (share, count) => Math.min(Math.max(Math.floor(share * count), 0), count - 1);
    state.cell[right] = within(u, n[right]);
    state.cell[vertical] = within(way < 0 ? 1 - v : v, n[vertical]);
    draw();
  }

  function key(event, axis) {
    const [right, vertical, way] = RIGHT_AND_VERTICAL[axis];
    const steps = { ArrowLeft: [right, -1], ArrowRight: [right, 1], ArrowUp: [vertical, -way], ArrowDown: [vertical, way],
      PageUp: [axis, 1], PageDown: [axis, -1] };
    if (!steps[event.key]) return;
    event.preventDefault();
    const [along, step] = steps[event.key];
    state.cell[along] = Math.min(Math.max(state.cell[along] + step, 0), state.grid.cells[along] - 1);
    draw();
  }

  function drawSlice({ axis, canvas, slider, caption, scale }, colour) {
    const [right, vertical, way] = RIGHT_AND_VERTICAL[axis], n = state.grid.cells;
    const context = canvas.getContext("2d"), image = context.createImageData(canvas.width, canvas.height);
    const cell = [...state.cell];
    for (let row = 0; row < n[vertical]; ++row) {
      cell[vertical] = way < 0 ? n[vertical] - 1 - row : row;
      for (let column = 0; column < n[right]; ++column) {
        cell[right] = column;
        const [r, g, b] = colour(at(cell));
        for (let y = 0; y < scale; ++y)
          for (let x = 0; x < scale; ++x)
            image.data.set([r, g, b, 255], 4 * ((row * scale + y) * canvas.width + column * scale + x));
      }
    }
    context.putImageData(image, 0, 0);
    context.strokeStyle = css("--accent");
    const shown = way < 0 ? n[vertical] - 1 - state.cell[vertical] : state.cell[vertical];
    context.lineWidth = Math.max(1, scale / 8);
    context.strokeRect(state.cell[right] * scale + 0.5, shown * scale + 0.5, scale - 1, scale - 1);
    const place = state.grid.centre[axis] + state.cell[axis] * state.grid.cell_m[axis];
    slider.value = state.cell[axis];
    caption.textContent = `${"xyz"[axis]} = ${state.grid.first[axis] + state.cell[axis]}: ${figure(place)} m; ` +
      `right +${"xyz"[right]}, ${way < 0 ? "up" : "down"} +${"xyz"[vertical]}`;
    canvas.setAttribute("aria-label", `Slice ${caption.textContent}`);
  }

  function say() {
    const i = at(state.cell), n = channels(), index = state.cell.map((c, k) => c + state.grid.first[k]);
    const place = state.cell.map((c, k) => figure(state.grid.centre[k] + c * state.grid.cell_m[k]));
    const held = state.scalar.held[i];
    const numbers = Array.from(state.field.values.subarray(n * i, n * (i + 1)), figure).join(" ");
    byId("readout").textContent = `cell ${index.join(", ")} at ${place.join(", ")} m: ` +
      (held === NONE ? "no value" : held === NO_NUMBER ? "no number" : `${numbers} ${state.grid.unit}`);
  }

  // --- histogram ----------------------------------------------------------------------------------------------------

  function drawHistogram() {
    const canvas = byId("histogram"), context = canvas.getContext("2d"), bins = 80;
    const { low, high, mean, count } = state.stats, { scalar, held } = state.scalar, counts = new Array(bins).fill(0);
    for (let i = 0; i < scalar.length; ++i)
      if (held[i] === NUMBER) ++counts[high > low ? Math.min(Math.floor((scalar[i] - low) / (high - low) * bins), bins - 1) : 0];
    context.clearRect(0, 0, canvas.width, canvas.height);
    const most = Math.log1p(Math.max(...counts, 1)), width = canvas.width / bins, [from, to] = range();
    for (let k = 0; k < bins; ++k) {
      const value = low + (k + 0.5) / bins * (high - low), height = Math.log1p(counts[k]) / most * (canvas.height - 8);
      context.fillStyle = value >= from && value <= to ? css("--accent") : css("--faint");
      context.fillRect(k * width, canvas.height - height, width - 1, height);
    }
    byId("histogram-text").textContent = `${count} cells of ${scalar.length}, ${figure(low)} to ${figure(high)}, mean ${figure(mean)} ` +
      `${state.grid.unit}; heights are logarithms`;
  }

  // --- in space -----------------------------------------------------------------------------------------------------

  function drawOrbit() {
    const canvas = byId("orbit"), n = state.grid.cells, { scalar, held } = state.scalar, [from] = range(), colour = painter();
    canvas.width = Math.max(Math.min(Math.round(canvas.clientWidth), 900), 200);
    canvas.height = Math.round(0.75 * canvas.width);
    const context = canvas.getContext("2d"), image = context.createImageData(canvas.width, canvas.height);
    const depth = new Float32Array(canvas.width * canvas.height).fill(-Infinity);
    const seen = (x, y, z) => x >= 0 && y >= 0 && z >= 0 && x < n[0] && y < n[1] && z < n[2] &&
      held[at([x, y, z])] === NUMBER && scalar[at([x, y, z])] > from;
    const scale = state.zoom * 0.85 * Math.min(canvas.width, canvas.height) / Math.hypot(...n);
    const [ct, st, ch, sh] = [Math.cos(state.turn), Math.sin(state.turn), Math.cos(state.tilt), Math.sin(state.tilt)];
    const half = Math.ceil(scale * 0.75);
    let drawn = 0;
    for (let z = 0; z < n[2]; ++z) for (let y = 0; y < n[1]; ++y) for (let x = 0; x < n[0]; ++x) {
      if (!seen(x, y, z)) continue;
      const open = !seen(x - 1, y, z) || !seen(x + 1, y, z) || !seen(x, y - 1, z) || !seen(x, y + 1, z) || !seen(x, y, z - 1) || !seen(x, y, z + 1);
      if (!open) continue;
      ++drawn;
      const [a, b, c] = [x - n[0] / 2 + 0.5, y - n[1] / 2 + 0.5, z - n[2] / 2 + 0.5];
      const right = ct * a - st * c, back = st * a + ct * c;
      const up = ch * b - sh * back, near = sh * b + ch * back;
      const px = Math.round(canvas.width / 2 + scale * right), py = Math.round(canvas.height / 2 - scale * up);
      const rgb = colour(at([x, y, z])), shade = 0.65 + 0.35 * clamp(0.5 + near / Math.hypot(...n));
      for (let j = Math.max(py - half, 0); j < Math.min(py + half, canvas.height); ++j)
        for (let i = Math.max(px - half, 0); i < Math.min(px + half, canvas.width); ++i) {
          const k = j * canvas.width + i;
          if (near <= depth[k]) continue;
          depth[k] = near;
          image.data.set([rgb[0] * shade, rgb[1] * shade, rgb[2] * shade, 255], 4 * k);
        }
    }
    context.putImageData(image, 0, 0);
    canvas.dataset.drawn = drawn;
  }

  let orbitWanted = false;
  function orbitSoon() {
    if (orbitWanted) return;
    orbitWanted = true;
    requestAnimationFrame(() => { orbitWanted = false; drawOrbit(); });
  }
  function turn(by, up) {
    state.turn += by;
    state.tilt = Math.min(Math.max(state.tilt + up, -Math.PI / 2), Math.PI / 2);
    orbitSoon();
  }
  const zoom = (by) => { state.zoom = Math.min(Math.max(state.zoom * by, 0.3), 8); orbitSoon(); };
  byId("orbit").addEventListener("pointermove", (event) => { if (event.buttons) turn(event.movementX / 120, event.movementY / 120); });
  byId("orbit").addEventListener("pointerdown", (event) => byId("orbit").setPointerCapture(event.pointerId));
  byId("orbit").addEventListener("wheel", (event) => { event.preventDefault(); zoom(event.deltaY < 0 ? 1.15 : 1 / 1.15); }, { passive: false });
  byId("orbit").addEventListener("keydown", (event) => {
    const does = { ArrowLeft: () => turn(-0.15, 0), ArrowRight: () => turn(0.15, 0), ArrowUp: () => turn(0, 0.15),
      ArrowDown: () => turn(0, -0.15), "+": () => zoom(1.2), "-": () => zoom(1 / 1.2) }[event.key];
    if (does) { event.preventDefault(); does(); }
  });

  // --- together -----------------------------------------------------------------------------------------------------

  function draw() {
    const colour = painter();
    for (const slice of slices) drawSlice(slice, colour);
    say();
    drawHistogram();
    orbitSoon();
  }

  form.grid.replaceChildren(...grids.map((grid) => new Option(grid.name + (grid.unit ? ` [${grid.unit}]` : ""), grid.name)));
  form.grid.addEventListener("change", () => { chooseGrid(); describe(); });
  form.channel.addEventListener("change", () => takeScalar(true));
  for (const name of ["map", "low", "high", "log"]) form[name].addEventListener("change", draw);
  for (const name of ["azimuth", "height"]) form[name].addEventListener("input", () => takeField(false));
  form.whole.addEventListener("click", () => { setRange(state.stats.low, state.stats.high); draw(); });
  document.querySelector(".controls").addEventListener("submit", (event) => event.preventDefault());
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  addEventListener("resize", orbitSoon);
  function describe() {
    const { cells, cell_m: edge, active, description } = state.grid;
    byId("about").textContent = `${description ? description + ": " : ""}${cells.join(" × ")} cells of ${figure(edge[0])} m, ${active} with a value`;
  }
  const first = grids.findIndex((grid) => grid.name === "fluence");
  form.grid.selectedIndex = Math.max(first, 0);
  chooseGrid();
  describe();
})();
