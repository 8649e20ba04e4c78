import uPlot from 'uplot';
import { axisTitle, floats, numberText } from './data.js';

// Paul Tol's "bright" scheme, distinguishable with colour-blind eyes; then the same colours dashed.
const palette = ['#4477AA', '#EE6677', '#228833', '#AA3377', '#CCBB44', '#66CCEE', '#555555'];
const font = '12px "Liberation Sans", Arial, Helvetica, sans-serif';
const ink = '#222222', gridInk = '#e3e3e3';

// -- Data

// Numbers of one curve; NaN becomes null (a gap), and on a logarithmic axis so does what is not positive.
function curve(values, logarithmic) {
  return Array.from(values, (v) => (Number.isNaN(v) || (logarithmic && v <= 0) ? null : v));
}

// uPlot wants strictly ascending x.
function ascending(x) {
  for (let i = 1; i < x.length; i++)
    if (x[i] <= x[i - 1]) x[i] = x[i - 1] + Math.max(Math.abs(x[i - 1]), 1e-6) * 1e-9;
  return x;
}

// Edges of the bands around centres: half way between neighbours (geometrically on a logarithmic axis).
function bandEdges(x, logarithmic) {
  const c = logarithmic ? x.map(Math.log) : x;
  const n = c.length, half = n > 1 ? 0.5 : 0.05;
  const edges = [n > 1 ? c[0] - half * (c[1] - c[0]) : c[0] - half];
  for (let i = 1; i < n; i++) edges.push(0.5 * (c[i - 1] + c[i]));
  edges.push(n > 1 ? c[n - 1] + half * (c[n - 1] - c[n - 2]) : c[0] + half);
  return logarithmic ? edges.map(Math.exp) : edges;
}

function last(values, limit) {  // index of the last value <= limit, 0 if there is none
  let low = 0, high = values.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (values[middle] <= limit) low = middle; else high = middle;
  }
  return low;
}

function nearestWithValue(x, y, at) {
  let i = last(x, at);
  let before = i, after = i + 1;
  while (before >= 0 && y[before] === undefined) before--;
  while (after < x.length && y[after] === undefined) after++;
  if (before < 0) return after < x.length ? after : null;
  if (after >= x.length) return before;
  return at - x[before] <= x[after] - at ? before : after;
}

// -- Axes

function logarithmicTicks(low, high) {
  const decades = Math.log10(high / low);
  const factors = decades > 4 ? [1] : decades > 0.7 ? [1, 2, 5] : [1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8];
  const ticks = [];
  for (let k = Math.floor(Math.log10(low)); k <= Math.ceil(Math.log10(high)); k++)
    for (const factor of factors) {
      const tick = Number(`${factor}e${k}`);
      if (tick >= low * 0.999 && tick <= high * 1.001) ticks.push(tick);
    }
  return ticks;
}

function axisOptions(axis, isX) {
  const options = {
    label: axisTitle(axis),
    labelFont: font, font, stroke: ink, labelSize: isX ? 18 : 22, size: isX ? 26 : 58, gap: 4, labelGap: 0,
    grid: { stroke: gridInk, width: 1 },
    ticks: { stroke: '#999999', width: 1, size: 5 },
    border: { show: true, stroke: '#999999', width: 1 },
    values: (u, splits) => splits.map((v) => (v === null ? '' : numberText(v, 6))),
  };
  if (axis.ticks) {
    options.splits = (u, i, low, high) => axis.ticks.filter((v) => v >= low * 0.999 && v <= high * 1.001);
    options.filter = (u, splits) => splits;
  } else if (axis.log) {
    options.splits = (u, i, low, high) => logarithmicTicks(low, high);
    options.filter = (u, splits) => splits;
  }
  if (!isX)  // wide enough for the longest label
    options.size = (u, values) => 16 + 6.6 * Math.max(3, ...(values || []).map((v) => v.length));
  return options;
}

function range(axis, isX, bars) {
  return (u, low, high) => {
    if (low === null || high === null || low === undefined) [low, high] = axis.log ? [1, 10] : [0, 1];
    const zoomed = u.zoomed;
    if (axis.log) {
      if (!zoomed && !isX) [low, high] = low === high ? [low / 2, high * 2] : [low / 1.2, high * 1.2];
      if (!zoomed && isX && low === high) [low, high] = [low / 1.5, high * 1.5];
      if (!zoomed && isX && axis.pad) [low, high] = [low / 1.1, high * 1.1];
    } else if (!zoomed && !isX) {
      [low, high] = uPlot.rangeNum(low, high, { min: { pad: 0.06, soft: bars ? 0 : undefined, mode: bars ? 2 : 0 },
                                                max: { pad: 0.06, soft: undefined, mode: 0 } });
    } else if (!zoomed && low === high) {
      [low, high] = [low - 0.5, high + 0.5];
    }
    if (!zoomed && axis.min !== undefined) low = axis.min;
    if (!zoomed && axis.max !== undefined) high = axis.max;
    return [low, high];
  };
}

// -- One chart

export function drawChart(figure, chart) {
  const place = figure.querySelector('.plot');
  const xs = chart.xs.map((text) => ascending(Array.from(floats(text))));
  const stepped = new Map();  // edges -> centres, for the read-out
  const tables = [], options = [{}], bands = [];
  const add = (x, y, series) => { tables.push([x, y]); options.push(series); };

  // the bands lie below the curves
  for (const band of chart.bands) {
    const x = xs[band.x], fill = band.colour || '#bbbbbb';
    const side = { stroke: fill, width: 1, points: { show: false } };  // one entry in the legend for both
    add(x, curve(floats(band.upper), chart.y.log), { ...side, label: band.name, class: 'band' });
    add(x, curve(floats(band.lower), chart.y.log), { ...side, label: `${band.name}, lower`, class: 'unnamed' });
    bands.push({ series: [options.length - 2, options.length - 1], fill: `${fill}55` });
  }
  let colourOf = 0;
  for (const s of chart.series) {
    const index = colourOf;
    if (!s.colour) colourOf++;
    const stroke = s.colour || palette[index % palette.length];
    const series = { label: s.name, stroke, width: 1.5, points: { show: false } };
    if (s.stroke === 'dashed' || (!s.colour && index >= palette.length)) series.dash = [7, 4];
    let x = xs[s.x], y = curve(floats(s.y), chart.y.log);
    if (s.stroke === 'points') series.paths = () => null;
    if (s.stroke === 'points' || s.stroke === 'line_and_points')
      series.points = { show: true, size: 6, width: 1, stroke, fill: s.stroke === 'points' ? stroke : '#ffffff' };
    if (s.stroke === 'steps' || s.stroke === 'bars') {
      // two points per band, at its edges; neighbours meet in an upright line
      const edges = bandEdges(x, chart.x.log);
      stepped.set(options.length, { edges, centres: x });
      x = ascending(x.flatMap((c, i) => [edges[i], edges[i + 1]]));
      y = y.flatMap((v) => [v, v]);
      if (s.stroke === 'bars') series.fill = `${stroke}55`;
    }
    add(x, y, series);
  }
  const same = tables.every(([x]) => x === tables[0][0]) ||
               (stepped.size === tables.length && new Set(chart.series.map((s) => s.x)).size === 1);
  const data = same ? [tables[0][0], ...tables.map(([, y]) => y)] : uPlot.join(tables);
  const onlySteps = stepped.size === tables.length ? stepped.get(1) : null;
  const onlyPoints = chart.series.every((s) => s.stroke === 'points' || s.stroke === 'line_and_points');
  const bars = chart.series.some((s) => s.stroke === 'bars') && !chart.y.log;

  // read-out: the nearest sample of each curve
  options[0] = {
    label: axisTitle(chart.x),
    value: (u, v, series, i) => {
      if (i === null || i === undefined) return '';
      return numberText(onlySteps ? onlySteps.centres[i >> 1] : v, 4);
    },
  };
  for (const series of options.slice(1)) series.value = (u, v, s, i) => (i === null || i === undefined ? '' : numberText(v));
  const dataIdx = (u, series, i, at) => {
    if (onlySteps) return 2 * Math.min(last(onlySteps.edges, at), onlySteps.centres.length - 1);
    if (series === 0) return i;
    return nearestWithValue(data[0], data[series], at);
  };

  const width = () => Math.max(260, Math.floor(place.getBoundingClientRect().width));
  const plot = new uPlot({
    width: width(),
    height: chart.height,
    padding: [10, 14, 0, 0],
    scales: {
      x: { time: false, distr: chart.x.log ? 3 : 1, range: range({ ...chart.x, pad: onlyPoints }, true, false) },
      y: { distr: chart.y.log ? 3 : 1, range: range(chart.y, false, bars) },
    },
    axes: [axisOptions(chart.x, true), axisOptions(chart.y, false)],
    series: options,
    bands,
    legend: { show: true, live: true, markers: { width: 2, dash: (u, i) => (options[i].dash ? 'dashed' : 'solid') } },
    cursor: { dataIdx, drag: { x: true, y: true, uni: 24, setScale: true }, points: { size: 7 }, focus: { prox: 1e6 } },
    focus: { alpha: 1 },
    hooks: {
      setCursor: [(u) => u.root.classList.toggle('reading', u.cursor.left >= 0)],
      setSelect: [(u) => { if (u.select.width > 0) u.zoomed = true; }],
    },
  }, data, place);
  // uPlot's own double click asks for the full range of x; y follows since its range is automatic
  plot.over.addEventListener('dblclick', () => { plot.zoomed = false; plot.setData(data); }, true);

  plot.refit = (w) => {
    const newWidth = w || width();
    if (newWidth !== plot.width) plot.setSize({ width: newWidth, height: chart.height });
  };
  return plot;
}

// Whether curves, not only axes, have been drawn: coloured pixels inside the plot area.
export function isDrawn(plot) {
  const { left, top, width, height } = plot.bbox, edge = 8;  // the axes' lines lie on the border
  const pixels = plot.ctx.getImageData(left + edge, top + edge, width - 2 * edge, height - 2 * edge).data;
  let coloured = 0;
  for (let i = 0; i < pixels.length; i += 4)
    if (pixels[i + 3] > 128 && Math.min(pixels[i], pixels[i + 1], pixels[i + 2]) < 200) coloured++;
  return coloured > 20;
}
