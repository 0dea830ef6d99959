#include "app/identify/simulated_bench.h"

namespace limpid {
namespace {

constexpr double kMostFriction = 0.03;  // [N m]

}  // namespace

SimulatedBench simulated_bench(const IdentifyRequest& order, unsigned seed) {
  SimulatedBench bench{order.guess.name + ", simulated", unlike(order.guess, seed, kMostFriction),
                       drawn_bench(order.guess, seed, order.fit.gravity)};
  if (order.load > 0) bench.unlikeness.torque_scale = drawn_torque_scale(seed);
  return bench;
}

IdentifyRun move_simulated(const SimulatedBench& bench, const IdentifyRequest& order,
                           bool with_load, IdentifyProgress& progress) {
  UnlikeDevice device(with_load ? loaded(bench.truth, order.load) : bench.truth, bench.unlikeness);
  return simulate_identification(device, order.guess, order.plan, progress);
}

}  // namespace limpid
