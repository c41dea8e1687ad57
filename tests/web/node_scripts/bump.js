// bumps of cases: whether each overturns, and its rotations
const fs = require("fs");
const [wasm, cases, , out] = process.argv.slice(2);
rockfragKernel(new Uint8Array(fs.readFileSync(wasm))).then((kernel) => {
  const found = JSON.parse(fs.readFileSync(cases)).map((given) => kernel.bump(given));
  fs.writeFileSync(
    out,
    Buffer.concat(found.map(({ theta2 }) => Buffer.from(theta2.buffer))),
  );
  console.log(
    JSON.stringify(found.map(({ fallen, done, dt }) => ({ fallen, done, dt }))),
  );
});
