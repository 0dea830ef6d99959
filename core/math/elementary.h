// Sine, cosine, exponential, logarithm and power, the same to the last bit on every x86-64
// processor.
//
// The mathematical library of a system chooses its code by the processor, and the last bit of what
// it returns with it. A recording is to come again bit for bit on another machine; so whatever
// reaches a row asks here. Square root, absolute value, floor and remainder are exact everywhere:
// those of the library are good.
#pragma once

namespace limpid {

struct SineCosine {
  double sine, cosine;
};

// Of any angle [rad], within one unit in the last place; not a number of what is not finite.
SineCosine sine_cosine(double x);
inline double sine(double x) { return sine_cosine(x).sine; }
inline double cosine(double x) { return sine_cosine(x).cosine; }

// e^x, within one unit in the last place; 0 and infinity where doubles end.
double exponential(double x);

// Of a finite x above 0, within one unit in the last place.
double logarithm(double x);
// x^y of a finite x above 0, within one unit in the last place for results from 1e-15 to 1e15, and
// within two beyond.
double power(double x, double y);

}  // namespace limpid
