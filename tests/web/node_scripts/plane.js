// outcomes of bodies that something holds, under motions at scales
const fs = require("fs");
const [wasm, cases, motions, out] = process.argv.slice(2);
const numbers = new Float64Array(new Uint8Array(fs.readFileSync(motions)).buffer);
rockfragPlane(new Uint8Array(fs.readFileSync(wasm))).then((plane) => {
  const { bodies, counts, dts, scales } = JSON.parse(fs.readFileSync(cases));
  const shaking = shakingOf(numbers, counts, dts);
  const factors = Float64Array.from(scales);
  const records = [];
  const found = bodies.flatMap((given) => {
    const body = plane.bodyOf(given);
    records.push(Buffer.from(plane.recordOf(body)).toString("hex"));
    const { fell, rocked, loose, force, stroke } = plane.count(body, shaking, factors);
    return [fell, rocked, loose, force, stroke];
  });
  fs.writeFileSync(out, Buffer.concat(found.map(({ buffer }) => Buffer.from(buffer))));
  console.log(JSON.stringify(records));
});
