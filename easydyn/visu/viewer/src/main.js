// Draws the charts and the animation of a report page and says so: the root element gets data-ready once every
// canvas has been seen to hold a picture, or data-failure with what went wrong.
import './sharp.js';
import './style.css';
import { drawAnimation, hasWebGL, isShown } from './animation.js';
import { drawChart, isDrawn } from './chart.js';
import { pageData } from './data.js';

const root = document.documentElement;
const fail = (message) => { root.dataset.failure = message; };
window.addEventListener('error', (event) => fail(event.message));

// Paper cannot be opened: folded tables are printed whole and fold again afterwards.
function unfoldOnPaper() {
  let opened = [];
  window.addEventListener('beforeprint', () => {
    opened = [...document.querySelectorAll('details:not([open])')];
    opened.forEach((table) => { table.open = true; });
  });
  window.addEventListener('afterprint', () => opened.forEach((table) => { table.open = false; }));
}

function drawPage() {
  const data = pageData();
  const charts = [...document.querySelectorAll('figure[data-chart]')].map((figure) =>
      drawChart(figure, data.charts[Number(figure.dataset.chart)]));

  const scenes = [...document.querySelectorAll('figure[data-scene]')];
  const animations = [];
  if (hasWebGL())
    for (const figure of scenes) animations.push(drawAnimation(figure, data.scenes[Number(figure.dataset.scene)]));
  else
    for (const figure of scenes) figure.classList.add('without-webgl');

  // screens and paper have different widths
  const all = [...charts, ...animations];
  const refit = () => all.forEach((part) => part.refit());
  let waiting = null;
  window.addEventListener('resize', () => { clearTimeout(waiting); waiting = setTimeout(refit, 100); });
  window.addEventListener('beforeprint', refit);
  window.addEventListener('afterprint', refit);
  unfoldOnPaper();

  // the chart library draws in a microtask, the browser paints before the next frame
  setTimeout(() => {
    const empty = [...charts.map((c, i) => (isDrawn(c) ? null : `chart ${i + 1}`)),
                   ...animations.map((a, i) => (isShown(a) ? null : `animation ${i + 1}`))].filter(Boolean);
    if (empty.length > 0) fail(`nothing drawn in ${empty.join(', ')}`);
    root.dataset.charts = charts.length;
    root.dataset.animations = animations.length;
    if (!root.dataset.failure) root.dataset.ready = 'true';
  }, 50);
}

drawPage();
