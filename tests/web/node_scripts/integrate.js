// histories of cases; every array is written out, and what else there is is said
const HISTORY = [
  "theta1",
  "omega1",
  "theta2",
  "omega2",
  "c1",
  "c2",
  "alpha1",
  "alpha2",
  "work",
];
const fs = require("fs");
const [wasm, cases, motions, out] = process.argv.slice(2);
const bytes = new Float64Array(new Uint8Array(fs.readFileSync(motions)).buffer);
rockfragKernel(new Uint8Array(fs.readFileSync(wasm))).then((kernel) => {
  const found = [];
  const said = JSON.parse(fs.readFileSync(cases)).map(
    ({ given, start, count, lifted, ...rest }) => {
      let body;
      try {
        body = kernel.bodyOf(given);
      } catch (error) {
        return { error: error.message };
      }
      const samples = bytes.subarray(start, start + count);
      const more = lifted
        ? { vertical: bytes.subarray(0, count).map((a) => 0.6 * a) }
        : {};
      const r = kernel.integrate({ body, samples, ...rest, ...more });
      const outcome = kernel.integrate({
        body,
        samples,
        ...rest,
        ...more,
        history: false,
      });
      for (const name of HISTORY) found.push(Float64Array.from(r[name]));
      for (const number of [
        (e) => e.time,
        (e) => e.energy_after,
        (e) => e.before.omega2,
      ]) {
        found.push(Float64Array.from(r.contact_events, number));
      }
      const numbers = [
        "done",
        "fallen",
        "fallTime",
        "impacts",
        "grazings",
        "unstable_distance",
      ];
      return {
        ...Object.fromEntries(numbers.map((name) => [name, r[name]])),
        record: Buffer.from(body.record).toString("hex"),
        shaking: kernel.shakingOf(body, rest.dt),
        kinds: r.contact_events.map((e) => e.kind),
        alike: numbers.every((name) => Object.is(r[name], outcome[name])),
      };
    },
  );
  fs.writeFileSync(
    out,
    Buffer.concat(found.map((values) => Buffer.from(values.buffer))),
  );
  console.log(JSON.stringify(said));
});
