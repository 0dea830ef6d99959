// Python's module limpid._loop: the library's loops with rows as numpy arrays. The package's
// loop.py gives them their names and words.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "app/library/limpid/limpid.h"

namespace limpid {
namespace {

namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::span<const double> values(const Array& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

Array copied(std::span<const double> values) {
  return Array(static_cast<py::ssize_t>(values.size()), values.data());
}

// Returns the row and its derived columns behind it.
Array whole_row(const Loop& loop) {
  const std::span<const double> row = loop.row();
  const auto derived = loop.derived(row);
  Array whole(static_cast<py::ssize_t>(row.size() + derived.size()));
  std::ranges::copy(derived, std::ranges::copy(row, whole.mutable_data()).out);
  return whole;
}

py::tuple described(const RowColumn& column, std::size_t behind) {
  return py::make_tuple(column.path, column.unit, column.what, behind + column.offset,
                        py::tuple(py::cast(column.shape)));
}

// Takes the rows of a run as one array of rows x columns, without another copy.
Array as_rows(std::vector<double>&& all, std::size_t stride) {
  auto* kept = new std::vector<double>(std::move(all));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<double>*>(p); });
  const auto rows = static_cast<py::ssize_t>(kept->size() / stride);
  return Array({rows, static_cast<py::ssize_t>(stride)}, kept->data(), owner);
}

// Keeps these numbers of each row, by their offsets; those beyond the row are of its derived
// columns.
py::tuple run(const SimulatedLoop& loop, const Array& path, double duration,
              const std::vector<std::size_t>& kept) {
  const std::span<const double> rows(path.data(), static_cast<std::size_t>(path.size()));
  std::vector<double> all;
  const double seconds = duration > 0 || rows.size() < 4 ? duration : rows[rows.size() - 4];
  const std::size_t width = loop.row().size();
  const bool derives = std::ranges::any_of(kept, [&](std::size_t each) { return each >= width; });
  all.reserve(kept.size() * static_cast<std::size_t>(std::max(0.0, seconds / loop.period()) + 2));
  SimulatedLoop::RunEnd end;
  constexpr std::uint64_t kHeard = 1000;  // ticks after which Ctrl-C is heard
  std::uint64_t ticks = 0;
  {
    const py::gil_scoped_release others_go_on;
    end = loop.run(rows, duration, [&](std::span<const double> row) {
      const auto derived = derives ? loop.derived(row) : std::array<double, 15>{};
      for (const std::size_t each : kept) {
        all.push_back(each < width ? row[each] : derived[each - width]);
      }
      if (++ticks % kHeard != 0) return true;
      const py::gil_scoped_acquire for_signals;
      return PyErr_CheckSignals() == 0;
    });
  }
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  return py::make_tuple(as_rows(std::move(all), kept.size()), end.diverged, end.why, end.warnings);
}

Array step(SimulatedLoop& loop, const Array& target, double grip, bool magnet,
           const Array& torque) {
  SimulatedLoop::Hand hand;
  hand.target = {target.at(0), target.at(1), target.at(2)};
  hand.grip = grip;
  hand.magnet = magnet;
  hand.torque = values(torque);
  {
    const py::gil_scoped_release others_go_on;
    loop.step(hand);
  }
  return whole_row(loop);
}

Array tick(DeviceLoop& loop, const Array& position, bool fresh, bool hand, bool fault,
           double elapsed) {
  DeviceLoop::Reading reading;
  reading.position = values(position);
  reading.fresh = fresh;
  reading.hand = hand;
  reading.fault = fault;
  reading.elapsed = elapsed;
  std::span<const double> torque;
  {
    const py::gil_scoped_release others_go_on;
    torque = loop.tick(reading);
  }
  return copied(torque);
}

void declare_options(py::module_& module) {
  py::enum_<Motors>(module, "Motors")
      .value("real", Motors::real)
      .value("simulated", Motors::simulated);
  py::class_<LoopLimits>(module, "LoopLimits")
      .def(py::init<>())
      .def_readwrite("joint_speed", &LoopLimits::joint_speed)
      .def_readwrite("tip_speed", &LoopLimits::tip_speed)
      .def_readwrite("tip_force", &LoopLimits::tip_force)
      .def_readwrite("energy", &LoopLimits::energy)
      .def_readwrite("range", &LoopLimits::range);
  py::class_<LoopOptions>(module, "LoopOptions")
      .def(py::init<>())
      .def_readwrite("arm", &LoopOptions::arm)
      .def_readwrite("arm_text", &LoopOptions::arm_text)
      .def_readwrite("tip", &LoopOptions::tip)
      .def_readwrite("scene", &LoopOptions::scene)
      .def_readwrite("scene_text", &LoopOptions::scene_text)
      .def_readwrite("config", &LoopOptions::config)
      .def_readwrite("settings", &LoopOptions::settings)
      .def_readwrite("period", &LoopOptions::period)
      .def_readwrite("motors", &LoopOptions::motors)
      .def_readwrite("limits", &LoopOptions::limits);
}

void declare_loops(py::module_& module) {
  py::class_<Loop>(module, "Loop")
      .def_property_readonly("joints", &Loop::joints)
      .def_property_readonly("period", &Loop::period)
      .def_property_readonly("notes", &Loop::notes)
      .def_property_readonly("not_passive", &Loop::not_passive_text)
      .def_property_readonly("diverged", &Loop::diverged)
      .def_property_readonly("time", &Loop::time)
      .def_property_readonly("tip", &Loop::tip)
      .def_property_readonly("proxy_tip", &Loop::proxy_tip)
      .def("set", [](Loop& loop, const std::vector<std::string>& all) { loop.set(all); })
      .def("get", &Loop::get)
      .def("row", &whole_row)
      .def("columns",
           [](const Loop& loop) {
             py::list all;
             for (const RowColumn& each : loop.columns()) all.append(described(each, 0));
             for (const RowColumn& each : loop.derived_columns()) {
               all.append(described(each, loop.row().size()));
             }
             return all;
           })
      .def("energy",
           [](const Loop& loop) {
             const LoopEnergy now = loop.energy();
             return py::make_tuple(now.controller, now.commanded, now.port, now.reserve);
           })
      .def("record", &Loop::record)
      .def("finish_recording", &Loop::finish_recording, py::call_guard<py::gil_scoped_release>());
  py::class_<SimulatedLoop, Loop>(module, "SimulatedLoop")
      .def(py::init<const LoopOptions&>())
      .def("start", &SimulatedLoop::start)
      .def("step", &step)
      .def("run", &run);
  py::class_<DeviceLoop, Loop>(module, "DeviceLoop")
      .def(py::init([](const LoopOptions& options, const Array& position) {
        return DeviceLoop(options, values(position));
      }))
      .def("tick", &tick)
      .def("arm", &DeviceLoop::arm)
      .def("cut", &DeviceLoop::cut)
      .def_property_readonly("armed", &DeviceLoop::armed)
      .def_property_readonly("force_share", &DeviceLoop::force_share)
      .def_property_readonly("force_text", &DeviceLoop::force_text);
}

PYBIND11_MODULE(_loop, module) {
  module.doc() = "Limpid's basic loops; `limpid.Loop` and `limpid.DeviceLoop` are built on them.";
  py::register_exception<LoopError>(module, "LoopError",
                                    py::module_::import("limpid.errors").attr("LimpidError"));
  declare_options(module);
  declare_loops(module);
  module.def("version", &library_version);
  module.def("settings", [] {
    py::list all;
    for (const SettingInfo& each : setting_list()) {
      all.append(py::make_tuple(each.key, each.unit, each.least, each.most, each.words, each.live,
                                each.meaning));
    }
    return all;
  });
}

}  // namespace
}  // namespace limpid
