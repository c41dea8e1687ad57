// motions by how many samples each has, out of the numbers of all of them
function shakingOf(numbers, counts, dts) {
  let end = 0;
  return counts.map((n, i) => {
    const begin = end;
    end += n;
    return { samples: numbers.subarray(begin, end), dt: dts[i] };
  });
}
