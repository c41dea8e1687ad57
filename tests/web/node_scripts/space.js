// histories and outcomes of bodies in space
const fs = require("fs");
const [wasm, cases, motion, out] = process.argv.slice(2);
const samples = new Float64Array(new Uint8Array(fs.readFileSync(motion)).buffer);
const part = (k) =>
  samples.subarray((k * samples.length) / 3, ((k + 1) * samples.length) / 3);
const all = [part(0), part(1), part(2)];
rockfragSpace(new Uint8Array(fs.readFileSync(wasm))).then((space) => {
  const tables = [];
  const said = JSON.parse(fs.readFileSync(cases)).map(
    ({ block, solid, wall = null, bond = null, friction, components, dt, scale }) => {
      const body = space.bodyOf({
        ...(block ? rockfragSolid(block) : solid),
        friction,
        wall,
        bond,
      });
      const [x, y, z] = all.map((own, k) => (k < components ? own : null));
      const found = space.integrate({ body, x, y, z, dt, scale, history: true });
      const again = space.integrate({ body, x, y, z, dt, scale });
      tables.push(found.history);
      const { history, done, ...rest } = found;
      const alike = Object.keys(rest).every(
        (key) => String(rest[key]) === String(again[key]),
      );
      const numbers = ["certainTime", "fallDirection", "peak", "peakTilt", "turn"].map(
        (name) => rest[name],
      );
      tables.push(Float64Array.from([...numbers, ...rest.walk]));
      return {
        fell: rest.overturned,
        force: rest.force,
        done,
        record: Buffer.from(body.record).toString("hex"),
        alike,
      };
    },
  );
  fs.writeFileSync(
    out,
    Buffer.concat(tables.map((table) => Buffer.from(table.buffer))),
  );
  console.log(JSON.stringify(said));
});
