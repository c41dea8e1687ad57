define internal <2 x double> @fma2(<2 x double> %a, <2 x double> %b, <2 x double> %c) alwaysinline {
  %ka = fmul <2 x double> %a, <double 134217729.0, double 134217729.0>
  %kb = fmul <2 x double> %b, <double 134217729.0, double 134217729.0>
  %xa = fsub <2 x double> %ka, %a
  %xb = fsub <2 x double> %kb, %b
  %ah = fsub <2 x double> %ka, %xa
  %bh = fsub <2 x double> %kb, %xb
  %al = fsub <2 x double> %a, %ah
  %bl = fsub <2 x double> %b, %bh
  %p = fmul <2 x double> %a, %b
  %hh = fmul <2 x double> %ah, %bh
  %hl = fmul <2 x double> %ah, %bl
  %lh = fmul <2 x double> %al, %bh
  %ll = fmul <2 x double> %al, %bl
  %e1 = fsub <2 x double> %hh, %p
  %e2 = fadd <2 x double> %e1, %hl
  %e3 = fadd <2 x double> %e2, %lh
  %e = fadd <2 x double> %e3, %ll
  %s = fadd <2 x double> %p, %c
  %q = fsub <2 x double> %s, %p
  %w = fsub <2 x double> %s, %q
  %d1 = fsub <2 x double> %p, %w
  %d2 = fsub <2 x double> %c, %q
  %t = fadd <2 x double> %d1, %d2
  %u = fadd <2 x double> %t, %e
  %r = fadd <2 x double> %s, %u
  ret <2 x double> %r
}
