// What a record says at single frequencies, and how fast it dies away.
#pragma once

#include <complex>
#include <functional>
#include <vector>

namespace limpid {

// The complex amplitude of the part at frequency f [Hz] of samples T apart, first sample at t = 0:
// c cos(2 pi f t + p) gives c e^{jp}. Exact where the samples last whole periods of f.
std::complex<double> amplitude_at(const std::vector<double>& samples, double T, double f);

// The frequency where `f` (increasing) has `value` fall through `level`, between neighbours in
// log f; 0 if it does not.
double falls_through(const std::vector<double>& f, const std::vector<double>& value, double level);

// Rate s of the least-squares fit of e^{s t} to positive samples T apart [1/s]: negative where they
// decay.
double growth_rate(const std::vector<double>& samples, double T);

}  // namespace limpid
