/* Motions of floors of an elastic building, by the core's modes and steps, as
 * rockfrag.building has them.
 */
const floors = (data, core) => {
  "use strict";

  // modes of a floor: of a building that was given they stand in the page; of a
  // sketched one the core finds them
  function modesOf({ modes, sketched, slower, damping, level }) {
    if (modes)
      return modes.map((mode) => ({ ...mode, fraction: mode.fractions[level - 1] }));
    const { storeys, height, period } = sketched;
    const all = (value) => core.put(new Array(storeys).fill(value));
    return core.within(() => {
      const [masses, stiffnesses, softer] = [
        all(data.constants.STOREY_MASS),
        all(0),
        all(0),
      ];
      const square = () => core.zeros([storeys, storeys]);
      const memory = [square(), square()];
      const frequencies = core.zeros([2, storeys]);
      const fractions = square();
      core.call(
        "fill_stiffnesses",
        masses,
        all(height),
        period,
        ...memory,
        stiffnesses,
      );
      core.call("fill_slower", stiffnesses, slower, softer);
      core.call(
        "fill_modes",
        masses,
        softer,
        ...memory,
        frequencies,
        square(),
        fractions,
        core.zeros([2, storeys]),
      );
      const omegas = frequencies.values.slice(storeys);
      const own = fractions.values.slice((level - 1) * storeys, level * storeys);
      return Array.from(omegas, (omega, k) => ({ omega, damping, fraction: own[k] }));
    });
  }
  // acceleration of a floor under that of the ground
  const floorMotion = (floor, { samples, dt }) =>
    core.within(() => {
      const shape = [1, samples.length];
      const ground = core.put(samples);
      const [displacement, acceleration] = [core.zeros(shape), core.zeros(shape)];
      for (const { omega, damping, fraction } of modesOf(floor)) {
        const matrix = core.zeros([2, 4]);
        core.call("fill_propagator", omega, damping, dt, matrix);
        core.call(
          "add_mode",
          ground,
          dt,
          omega,
          damping,
          matrix,
          core.put([fraction]),
          displacement,
          acceleration,
        );
      }
      return { samples: acceleration.values.slice(), dt };
    });
  return { floorMotion };
};
if (typeof module !== "undefined") module.exports = floors;
