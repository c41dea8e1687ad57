/* The simulator of rockfrag in a page: plain script, no library, no network; works from
 * a file, and in Node. Needs module.js before it.
 *
 *   const kernel = await rockfragKernel(bytes);  // of integrate.wasm, a Uint8Array
 *   const body = kernel.bodyOf({statue: {width: 0.3, height: 1.2, mass: 200}});
 *   const response = kernel.integrate({body, samples, dt: 0.01, scale: 1.5});
 *   const statue = { width: 0.02, height: 0.09, mass: 1 };
 *   const hit = kernel.bump({ statue, velocity: 0.3, distance: 0.025 });
 *
 * Everything that is computed about a body is computed by the module, which is made
 * from the kernels that rockfrag.simulate runs: a history has its bits.
 */
async function rockfragKernel(bytes) {
  "use strict";
  const { memory, layout, call, arrays, reserve, read, write, array, run } =
    await rockfragModule(bytes);
  const { gravity, step, free_time: freeTime } = layout.constants;
  const KINDS = ["opening", "impact", "chatter", "lift-off"];
  const fields = layout.call.fields;
  const bodyAt = call + fields.body.at;

  // ---- bodies

  function given(block, name) {
    const numbers = rockfragBlock(block);
    for (const [key, value] of Object.entries(numbers)) {
      const free = key === "cg_offset" || key === "lean";
      const left = key === "inertia" || key === "cg_height";
      if (
        !(free ? Number.isFinite(value) : value > 0 || (left && Number.isNaN(value)))
      ) {
        throw new Error(`${name}: ${key} of ${value} cannot be used.`);
      }
    }
    return numbers;
  }

  // a body and its measured restitution: a ratio, of a stack [ground, interface]; null
  // conserves momentum
  function bodyOf({
    statue,
    pedestal = null,
    offset = 0,
    restitution = null,
    linear = false,
    g = gravity,
  }) {
    const [ground, between] = pedestal
      ? (restitution ?? [null, null])
      : [null, restitution];
    const byMomentum = { law: 0, value: 1 };
    const tiltOf = pedestal ? 1 : 2;
    reserve(arrays);
    new Uint8Array(memory.buffer, bodyAt, fields.body.size).fill(0);
    write(layout.call, call, {
      statue: given(statue, "statue"),
      offset,
      stacked: pedestal ? 1 : 0,
      ground: ground ?? NaN,
      interface: between ?? NaN,
      body: {
        gravity: g,
        linear: linear ? tiltOf : 0,
        after1r: byMomentum,
        after1l: byMomentum,
        after2r: byMomentum,
        after2l: byMomentum,
      },
    });
    if (pedestal) write(layout.call, call, { pedestal: given(pedestal, "pedestal") });
    run("describe");
    const { fault, fastest, slowest } = read(layout.call, call);
    if (fault !== 0) throw new Error(ROCKFRAG_FAULTS[fault]);
    return {
      record: new Uint8Array(memory.buffer.slice(bodyAt, bodyAt + fields.body.size)),
      fields: read(fields.body, bodyAt),
      stacked: Boolean(pedestal),
      fastest,
      slowest,
    };
  }

  function shakingOf(body, dt) {
    return {
      substeps: Math.max(1, Math.ceil((body.fastest * dt) / step - 1e-9)),
      freeSamples: Math.ceil(freeTime / body.slowest / dt),
    };
  }

  // ---- histories

  let room = 256; // events

  function runIntegration({
    body,
    samples,
    vertical = new Float64Array(0),
    dt,
    scale = 1,
    substeps,
    freeSamples,
    initial = {},
    history = true,
  }) {
    const steps = substeps && freeSamples !== undefined ? null : shakingOf(body, dt);
    const free = freeSamples ?? steps.freeSamples;
    const rows = history ? samples.length + free : 0;
    const samplesAt = arrays;
    const verticalAt = samplesAt + 8 * samples.length;
    const historyAt = verticalAt + 8 * vertical.length;
    const eventsAt = historyAt + rows * layout.sample.size;
    const places = history ? room : 0;
    reserve(eventsAt + places * layout.event.size);
    new Float64Array(memory.buffer, samplesAt, samples.length).set(samples);
    // the kernels take it over gravity
    const g = new DataView(body.record.buffer, body.record.byteOffset).getFloat64(
      fields.body.fields.gravity[0],
      true,
    );
    new Float64Array(memory.buffer, verticalAt, vertical.length).set(
      vertical.map((a) => a / g),
    );
    new Uint8Array(memory.buffer, bodyAt, fields.body.size).set(body.record);
    write(layout.call, call, {
      initial: { c1: 0, c2: 0, theta1: 0, omega1: 0, theta2: 0, omega2: 0, ...initial },
      scale,
      dt,
      substeps: substeps ?? steps.substeps,
      free_samples: free,
    });
    run(
      "integrate",
      ...array(samplesAt, [samples.length], 8),
      ...array(verticalAt, [vertical.length], 8),
      ...array(historyAt, [rows], layout.sample.size),
      ...array(eventsAt, [places], layout.event.size),
    );
    const { summary, done } = read(layout.call, call);
    if (history && summary.contact_events > room) {
      room = 2 * summary.contact_events;
      return runIntegration({
        body,
        samples,
        vertical,
        dt,
        scale,
        substeps,
        freeSamples,
        initial,
        history,
      });
    }
    return {
      done,
      fallen: summary.fallen,
      fallTime: summary.fall_time,
      ...summary,
      ...(history ? columns(historyAt, done) : {}),
      contact_events: history ? listed(eventsAt, summary.contact_events) : [],
    };
  }

  // a lone block on a base that is hit, runs a distance and is stopped at once; the
  // jumps are the module's
  function bump({ statue, velocity, distance, dt = 0.005 }) {
    const body = bodyOf({ statue });
    const time = distance / velocity;
    const count = Math.max(1, Math.ceil(time / dt - 1e-9));
    const motion = { body, dt: time / count, scale: 1 };
    const jumped = (state, right) => {
      write(layout.call, call, {
        initial: { c1: 0, c2: 0, theta1: 0, omega1: 0, theta2: 0, omega2: 0, ...state },
        right,
        up: 0,
      });
      run("jump");
      return read(layout.call, call).initial;
    };
    const { substeps, freeSamples } = shakingOf(body, motion.dt);
    const runs = runIntegration({
      ...motion,
      samples: new Float64Array(count + 1),
      substeps,
      freeSamples: 0,
      initial: jumped({}, velocity),
    });
    if (runs.fallen) return { ...runs, dt: motion.dt };
    const [theta2, omega2, c2] = ["theta2", "omega2", "c2"].map(
      (name) => runs[name][runs.done - 1],
    );
    // bodyOf has not been called since: the block is still the one described
    const rests = runIntegration({
      ...motion,
      samples: new Float64Array(2),
      substeps,
      freeSamples,
      initial: jumped({ theta2, omega2, c2 }, -velocity),
    });
    const joined = Float64Array.from([...runs.theta2, ...rests.theta2.subarray(1)]);
    return { fallen: rests.fallen, dt: motion.dt, done: joined.length, theta2: joined };
  }

  function columns(at, done) {
    const view = new DataView(memory.buffer);
    const found = {};
    for (const [name, [offset, kind]] of Object.entries(layout.sample.fields)) {
      const values = kind === "f8" ? new Float64Array(done) : new Int8Array(done);
      for (
        let i = 0, place = at + offset;
        i < done;
        i += 1, place += layout.sample.size
      ) {
        // contact states are whole numbers below 128, of which the first byte has all
        values[i] = kind === "f8" ? view.getFloat64(place, true) : view.getInt8(place);
      }
      found[name] = values;
    }
    return found;
  }

  function listed(at, count) {
    const size = layout.event.size;
    return Array.from({ length: count }, (_, i) => {
      const event = read(layout.event, at + i * size);
      return { ...event, kind: KINDS[event.kind] };
    });
  }

  return { bodyOf, shakingOf, integrate: runIntegration, bump, restitution: true };
}
