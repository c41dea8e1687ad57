"""Levels of a motion that need to be simulated: a scan, and a band about where its outcomes change; compiled.

Below the level at which statics say that it lifts the object a motion does nothing. From there on every third
level is simulated first, and then all between the last one below the first that topples the object and the first
one above the last that does not: outcomes that change there and back are kept. A level that was not simulated has
the outcome of the next simulated one below.
"""

from rockfrag.assess.core.compiled import entry_kernel

STRIDE = 3  # Levels from one of the scan to the next


@entry_kernel
def fill_scan(scales, lifting, scan):
    """Levels that are simulated first.

    Parameters
    ----------
    scales : factors on each motion, rising, shape (motions, levels)
    lifting : factor from which each motion lifts the object, shape (motions,)
    scan : whether a level is simulated, shape (motions, levels)
    """
    for m in range(lifting.size):
        count, last = 0, -1
        for k in range(scales.shape[1]):
            scan[m, k] = False
            if scales[m, k] >= lifting[m]:
                scan[m, k] = count % STRIDE == 0
                count += 1
                last = k
        if last >= 0:
            scan[m, last] = True


@entry_kernel
def fill_band(scales, lifting, scan, fell, band, sources):
    """Levels that are simulated then, and of each level that whose outcome it has.

    Parameters
    ----------
    scales, lifting, scan : as in :func:`fill_scan`
    fell : what toppled in the scan, shape (motions, levels)
    band : whether a level is simulated too, shape (motions, levels)
    sources : place of the level whose outcome counts, shape (motions, levels)
    """
    size = scales.shape[1]
    for m in range(lifting.size):
        first, last = size, -1
        for k in range(size):
            if scan[m, k] and fell[m, k]:
                first = min(first, k)
            elif scan[m, k]:
                last = k
        low, high = -1, size
        for k in range(size):
            if scan[m, k] and k < first:
                low = k
            if scan[m, size - 1 - k] and size - 1 - k > last:
                high = size - 1 - k
        here = 0
        for k in range(size):
            lifts = scales[m, k] >= lifting[m]
            changes = first < size and last >= 0 and low < k < high
            band[m, k] = lifts and changes and not scan[m, k]
            if not lifts or scan[m, k] or band[m, k]:
                here = k
            sources[m, k] = here
