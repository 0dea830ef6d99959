// Sine, cosine, exponential, logarithm and power, the same to the last bit on every x86-64
// processor.
//
// A system's mathematical library chooses its code by the processor, which can change the last bit.
// A recording must repeat bit for bit on another machine, so all that reaches a row uses these
// functions. The library's square root, absolute value, floor and remainder are exact everywhere
// and may be used.
#pragma once

namespace limpid {

struct SineCosine {
  double sine, cosine;
};

// Sine and cosine of any angle [rad], within one unit in the last place; NaN if x is not finite.
SineCosine sine_cosine(double x);
inline double sine(double x) { return sine_cosine(x).sine; }
inline double cosine(double x) { return sine_cosine(x).cosine; }

// e^x, within one unit in the last place; 0 and infinity beyond the range of doubles.
double exponential(double x);

// Natural logarithm of a finite x above 0, within one unit in the last place.
double logarithm(double x);
// x^y of a finite x above 0, within one unit in the last place for results from 1e-15 to 1e15, and
// within two beyond.
double power(double x, double y);

}  // namespace limpid
