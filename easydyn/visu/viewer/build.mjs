// Bundles src/ into dist/viewer.js and dist/viewer.css; run by `npm run build`. `--out DIR` writes elsewhere.
import { build } from 'esbuild';
import { readFileSync } from 'node:fs';

const out = process.argv.includes('--out') ? process.argv[process.argv.indexOf('--out') + 1] : 'dist';

// The bundle travels inside every report, so it carries the full licence texts of what it contains.
const licence = (name, file) => {
  const version = JSON.parse(readFileSync(`node_modules/${name}/package.json`)).version;
  return `${name} ${version}\n\n${readFileSync(`node_modules/${name}/${file}`, 'utf8').replace(/\r/g, '').trim()}\n`;
};
const banner = `/*! Charts and animation of the EasyDyn report (BSD-3-Clause), with\n\n` +
               `${licence('three', 'LICENSE')}\n${licence('uplot', 'LICENSE')}*/`;

await build({
  entryPoints: { viewer: 'src/main.js' },
  outdir: out,
  bundle: true,
  minify: true,
  format: 'iife',
  target: ['es2020'],
  legalComments: 'none',
  banner: { js: banner },
  logLevel: 'info',
});
