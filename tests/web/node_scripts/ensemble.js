// outcomes of bodies under motions at scales
const fs = require("fs");
const [wasm, cases, motions, out] = process.argv.slice(2);
const numbers = new Float64Array(new Uint8Array(fs.readFileSync(motions)).buffer);
rockfragEnsemble(new Uint8Array(fs.readFileSync(wasm))).then((ensemble) => {
  const { bodies, counts, dts, scales } = JSON.parse(fs.readFileSync(cases));
  const shaking = shakingOf(numbers, counts, dts);
  const found = bodies.flatMap((given) => {
    const body = ensemble.bodyOf(given);
    // in two parts, as a page does
    const ends = [
      [0, 1],
      [1, counts.length],
    ];
    const parts = ends.map(([first, last]) =>
      ensemble.count(body, shaking, scales, first, last),
    );
    return ["overturned", "rocked"].flatMap((name) => parts.map((part) => part[name]));
  });
  fs.writeFileSync(out, Buffer.concat(found));
});
