/* Outcomes of a body under many motions at many levels, as rockfrag's `overturns`
 * counts them; needs module.js.
 *
 *   const ensemble = await rockfragEnsemble(bytes);  // of ensemble.wasm, a Uint8Array
 *   const body = ensemble.bodyOf({ statue: { width: 0.3, height: 1.2, mass: 200 } });
 *   const found = ensemble.count(body, motions, scales);
 *
 * The lanes are those of the package. Multiply-adds of `ensemble-fused.wasm` are
 * instructions that some browsers do not know and some processors do not fuse
 * (`roundsOnce`); those of `ensemble.wasm` take six times as long.
 */
async function rockfragEnsemble(bytes) {
  "use strict";
  const { memory, layout, call, arrays, reserve, read, write, array, run } =
    await rockfragModule(bytes);
  const {
    gravity,
    step,
    stack_step: stackStep,
    free_time: freeTime,
    block: BLOCK,
  } = layout.constants;
  const { fields } = layout.call;

  // a block, or one on a pedestal, by the names of `rockfragStanding`
  function bodyOf(given) {
    reserve(arrays);
    new Uint8Array(memory.buffer, call, layout.call.size).fill(0);
    write(layout.call, call, rockfragStanding(given));
    const gravityAt = fields.body[0] + layout.body.fields.gravity[0];
    reserve(0).setFloat64(call + gravityAt, gravity, true);
    run("describe");
    const described = read(
      { fields: Object.fromEntries(DESCRIBED.map((name) => [name, fields[name]])) },
      call,
    );
    if (described.fault !== 0) throw new Error(ROCKFRAG_FAULTS[described.fault]);
    return {
      ...described,
      stacked: Boolean(given.pedestal),
      centre: [...new Float64Array(memory.buffer, call + fields.centre[0], 3)],
      record: new Uint8Array(
        memory.buffer.slice(
          call + fields.body[0],
          call + fields.body[0] + layout.body.size,
        ),
      ),
      pivots: new Uint8Array(
        memory.buffer.slice(
          call + fields.pivots[0],
          call + fields.pivots[0] + 2 * layout.pivot.size,
        ),
      ),
    };
  }
  const DESCRIBED = ["fault", "fastest", "slowest", "uplift", "largest"];

  // whether a multiply-add rounds once: (1 + ε)(1 - ε) - 1 is -ε², and 0 where the
  // product is rounded
  function roundsOnce() {
    const small = 2 ** -30;
    reserve(arrays);
    write(layout.call, call, {
      above: 1 + small,
      restitution_factor: 1 - small,
      uplift: -1,
    });
    run("multiplyAdd");
    return read({ fields: { uplift: fields.uplift } }, call).uplift === -(small ** 2);
  }

  // how many times as densely a motion is sampled for a body: the next power of two
  function density(body, dt) {
    const needed = Math.max(1, Math.ceil((body.fastest * dt) / step - 1e-9));
    return 2 ** Math.ceil(Math.log2(needed));
  }

  // ---- motions end to end, sampled as densely as a body needs

  // with extremes of each block of samples

  const packed = new WeakMap();
  let loaded = null;

  function pack(motions, times) {
    const key = times.join();
    const known = packed.get(motions) ?? packed.set(motions, new Map()).get(motions);
    if (known.has(key)) return known.get(key);
    const sizes = motions.map(({ samples }, i) => samples.length * times[i] + 1);
    const offsets = [0];
    for (const size of sizes)
      offsets.push(offsets.at(-1) + Math.ceil(size / BLOCK) * BLOCK);
    const samples = new Float64Array(offsets.at(-1));
    motions.forEach((motion, i) =>
      refine(motion.samples, times[i], samples.subarray(offsets[i])),
    );
    const blocks = samples.length / BLOCK;
    const extremes = new Float64Array(4 * blocks);
    const [high, low, aheadHigh, aheadLow] = [0, 1, 2, 3].map((row) =>
      extremes.subarray(row * blocks, (row + 1) * blocks),
    );
    motions.forEach((_, i) => {
      let most = -Infinity;
      let least = Infinity;
      for (
        let block = offsets[i + 1] / BLOCK - 1;
        block >= offsets[i] / BLOCK;
        block--
      ) {
        const own = samples.subarray(block * BLOCK, (block + 1) * BLOCK);
        high[block] = Math.max(...own);
        low[block] = Math.min(...own);
        most = Math.max(most, high[block]);
        least = Math.min(least, low[block]);
        aheadHigh[block] = most;
        aheadLow[block] = least;
      }
    });
    const places = new BigInt64Array(2 * offsets.length);
    offsets.forEach((at, i) => {
      places[i] = BigInt(at);
    });
    sizes.forEach((size, i) => {
      places[offsets.length + i] = BigInt(offsets[i] + size - 1);
    });
    const made = { samples, extremes, places, blocks, count: offsets.length };
    known.set(key, made);
    return made;
  }

  // a piecewise linear motion that ends in zero, `times` as densely
  function refine(values, times, into) {
    if (times === 1) return into.set(values);
    for (let i = 0; i < values.length * times; i++) {
      const k = Math.floor(i / times);
      const here = values[k];
      const next = k + 1 < values.length ? values[k + 1] : 0;
      into[i] = (next - here) * (i / times - k) + here;
    }
  }

  function load(tables) {
    if (loaded?.tables === tables) return loaded;
    let end = arrays;
    const place = (values) => {
      const at = end;
      end += values.byteLength;
      return at;
    };
    const at = [tables.samples, tables.extremes, tables.places].map(place);
    reserve(end);
    [tables.samples, tables.extremes, tables.places].forEach((values, i) => {
      new values.constructor(memory.buffer, at[i], values.length).set(values);
    });
    loaded = {
      tables,
      end,
      parameters: [
        ...array(at[0], [tables.samples.length], 8),
        ...array(at[1], [4, tables.blocks], 8),
        ...array(at[2], [2, tables.count], 8),
      ],
    };
    return loaded;
  }

  // ---- outcomes

  // what motions first to last - 1 do at factors on them, (motions, scales); both
  // results are (last - first, scales)
  function count(body, motions, scales, first = 0, last = motions.length) {
    const tables = load(
      pack(
        motions,
        motions.map(({ dt }) => density(body, dt)),
      ),
    );
    const many = last - first;
    const each = scales.length / motions.length;
    const cases = many * each;
    const record = body.stacked ? 8 : layout.pivot.size;
    let end = tables.end;
    const place = (size) => {
      const at = end;
      end += size;
      return at;
    };
    const bodiesAt = place(2 * many * record);
    const factorsAt = place(8 * cases);
    const rowsAt = place(8 * many);
    const intervalsAt = place(8 * many);
    const freeAt = place(8 * many);
    const outcomesAt = place(cases * layout.outcome.size);
    const view = reserve(end);
    const factors = new Float64Array(memory.buffer, factorsAt, cases);
    for (let i = 0; i < cases; i++) {
      const scale = scales[first * each + i];
      factors[i] = body.stacked ? scale : scale / gravity;
    }
    const { swing, per_swing: perSwing } = layout.pivot.fields;
    for (let i = 0; i < many; i++) {
      const { dt } = motions[first + i];
      const interval = dt / density(body, dt);
      view.setBigInt64(rowsAt + 8 * i, BigInt(first + i), true);
      view.setFloat64(intervalsAt + 8 * i, interval, true);
      view.setBigInt64(
        freeAt + 8 * i,
        body.stacked ? BigInt(Math.ceil(freeTime / body.slowest / interval)) : 0n,
        true,
      );
      if (body.stacked) {
        const parts = Math.max(
          1,
          Math.ceil((body.fastest * interval) / (stackStep * step) - 1e-9),
        );
        view.setFloat64(bodiesAt + 8 * i, 1 / parts, true);
        continue;
      }
      const at = bodiesAt + 2 * i * record;
      new Uint8Array(memory.buffer, at, 2 * record).set(body.pivots);
      for (const pivot of [at, at + record]) {
        view.setFloat64(
          pivot + swing[0],
          view.getFloat64(pivot + swing[0], true) * (interval * interval),
          true,
        );
        view.setFloat64(
          pivot + perSwing[0],
          view.getFloat64(pivot + perSwing[0], true) / (interval * interval),
          true,
        );
      }
    }
    new Uint8Array(memory.buffer, call + fields.body[0], layout.body.size).set(
      body.record,
    );
    write(layout.call, call, { cases });
    view.setBigInt64(call + fields.counter[0], 0n, true);
    run(
      body.stacked ? "countStacks" : "countBlocks",
      ...(body.stacked
        ? array(bodiesAt, [1, many], 8)
        : array(bodiesAt, [1, many, 2], record)),
      ...array(factorsAt, [many, each], 8),
      ...array(rowsAt, [1, many], 8),
      ...array(intervalsAt, [1, many], 8),
      ...array(freeAt, [1, many], 8),
      ...tables.parameters,
      ...array(outcomesAt, [cases], layout.outcome.size),
    );
    const overturned = new Uint8Array(cases);
    const rocked = new Uint8Array(cases);
    const { fallen, peak1, peak2 } = layout.outcome.fields;
    for (let i = 0, at = outcomesAt; i < cases; i++, at += layout.outcome.size) {
      overturned[i] = view.getInt32(at + fallen[0], true) > 0 ? 1 : 0;
      const turned =
        view.getFloat64(at + peak2[0], true) > 0 ||
        (body.stacked && view.getFloat64(at + peak1[0], true) > 0);
      rocked[i] = overturned[i] || turned ? 1 : 0;
    }
    return { overturned, rocked };
  }

  return { bodyOf, count, roundsOnce, gravity };
}
