#include "app/desktop/base/settings.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <sstream>

#include "app/base/user_dirs.h"
#include "app/desktop/base/plot_toml.h"
#include "devices/files/atomic_file.h"
#include "devices/files/config/config_file.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

fs::path made(const fs::path& dir) {
  std::error_code error;
  fs::create_directories(dir, error);
  return dir;
}

constexpr std::size_t kMostRecent = 8;

fs::path settings_file() { return user_config_dir() / "settings.toml"; }

// Every setting but the parameters, once, for reading and writing.
template <class S, class Visit>
void each(S& s, Visit&& visit) {
  visit("ui_scale", s.ui_scale);
  visit("width", s.width);
  visit("height", s.height);
  visit("left", s.left);
  visit("right", s.right);
  visit("plots", s.plots);
  visit("show_left", s.show_left);
  visit("show_right", s.show_right);
  visit("show_plots", s.show_plots);
  visit("show_ghost", s.show_ghost);
  visit("show_trail", s.show_trail);
  visit("show_forces", s.show_forces);
  visit("show_grid", s.show_grid);
  visit("show_lens", s.show_lens);
  visit("show_joints", s.show_joints);
  visit("twin_overlaid", s.twin_overlaid);
  visit("hold_on_release", s.hold_on_release);
  visit("hint_seen", s.hint_seen);
  visit("picture_quality", s.picture_quality);
  visit("plot_length", s.plot_length);
  visit("band", s.band);
  visit("device", s.device);
  visit("device_tip", s.device_tip);
  visit("scene", s.scene);
  visit("gamepad", s.gamepad);
}

}  // namespace

void remember_recent(Settings& settings, const std::string& file) {
  std::erase(settings.recent, file);
  settings.recent.insert(settings.recent.begin(), file);
  if (settings.recent.size() > kMostRecent) settings.recent.resize(kMostRecent);
}

Settings load_settings(std::string& complaint) {
  Settings s;
  const fs::path file = settings_file();
  std::error_code none;
  if (!fs::exists(file, none)) return s;
  try {
    const toml::table table = toml::parse_file(file.string());
    each(s, [&](const char* key, auto& value) {
      using T = std::remove_reference_t<decltype(value)>;
      if (const auto found = table["window"][key].value<T>()) value = *found;
    });
    if (const toml::array* recent = table["window"]["recent"].as_array()) {
      for (const toml::node& node : *recent) {
        if (const auto name = node.value<std::string>()) s.recent.push_back(*name);
      }
    }
    if (table["window"]["theme"].value_or(std::string("dark")) == "light") s.theme = Theme::light;
    const auto read = [&](const auto& part) {
      try {
        part();
      } catch (const std::exception& e) {
        complaint = fmt::format("settings not read: {}", e.what());
      }
    };
    const auto parameters = [&](const char* key, Parameters& p) {
      const toml::table* found = table[key].as_table();
      if (found == nullptr) return;
      std::ostringstream text;
      text << toml::toml_formatter(*found);
      apply_config_text(p, text.str(), file.string());
    };
    read([&] { parameters("parameters", s.parameters); });
    s.parameters.tick = Parameters{}.tick;
    s.parameters.substeps = Parameters{}.substeps;
    read([&] { parameters("twin", s.twin.parameters); });
    read([&] { s.plot_choices = plots_of(table, file.string()); });
  } catch (const std::exception& e) {
    complaint = fmt::format("settings not read: {}", e.what());
  }
  return s;
}

std::string save_settings(const Settings& settings) {
  toml::table window;
  each(settings, [&](const char* key, const auto& value) { window.insert(key, value); });
  toml::array recent;
  for (const std::string& name : settings.recent) recent.push_back(name);
  window.insert("recent", recent);
  window.insert("theme", settings.theme == Theme::light ? "light" : "dark");
  toml::table all;
  all.insert("window", window);
  all.insert("plot", plots_toml(settings.plot_choices));
  all.insert("parameters", toml::parse(config_text(settings.parameters)));
  all.insert("twin", toml::parse(config_text(settings.twin.parameters)));
  std::ostringstream text;
  text << all << '\n';
  return try_write_atomically(settings_file(), text.str());
}

fs::path sessions_dir() { return made(user_data_dir() / "sessions"); }
fs::path scenes_dir() { return made(user_data_dir() / "scenes"); }

}  // namespace limpid
