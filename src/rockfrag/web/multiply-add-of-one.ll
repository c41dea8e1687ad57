define internal double @fma1(double %a, double %b, double %c) alwaysinline {
  %va = insertelement <2 x double> zeroinitializer, double %a, i32 0
  %vb = insertelement <2 x double> zeroinitializer, double %b, i32 0
  %vc = insertelement <2 x double> zeroinitializer, double %c, i32 0
  %r = call <2 x double> @fma2(<2 x double> %va, <2 x double> %vb, <2 x double> %vc)
  %x = extractelement <2 x double> %r, i32 0
  ret double %x
}
