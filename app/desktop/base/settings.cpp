#include "app/desktop/base/settings.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <sstream>

#include "app/base/folders.h"
#include "app/desktop/base/first_steps.h"
#include "app/desktop/base/kept_settings.h"
#include "devices/files/atomic_file.h"
#include "devices/files/config_file.h"
#include "devices/files/text_file.h"
#include "devices/files/toml_reader.h"

namespace limpid {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPlots = 24, kMostChannels = 32;
constexpr std::array kThemes{"dark", "light", "contrast"};  // by Theme
constexpr std::array kKinds{PlotKind::time, PlotKind::cross, PlotKind::spectrum};

PlotChoice plot_of(const TomlTable& table) {
  table.allow_only({"title", "kind", "across", "channels"});
  PlotChoice plot{.title = table.text("title").value_or(""),
                  .across = table.text("across").value_or("")};
  if (const auto text = table.text("kind")) {
    const auto* kind =
        std::ranges::find(kKinds, *text, [](PlotKind k) { return std::string(name(k)); });
    if (kind == kKinds.end()) table.refuse("kind", "\"time\", \"cross\", \"spectrum\"");
    plot.kind = *kind;
  }
  const toml::node* node = table.find("channels");
  if (node == nullptr) return plot;
  const toml::array* keys = node->as_array();
  const bool texts = keys != nullptr && keys->size() <= kMostChannels &&
                     std::ranges::all_of(*keys, [](const auto& key) { return key.is_string(); });
  if (!texts) {
    table.refuse("channels", "a list of at most 32 texts, such as \"device/position.2\"");
  }
  for (const toml::node& key : *keys) plot.channels.push_back(*key.value<std::string>());
  return plot;
}

fs::path made(const fs::path& dir) {
  std::error_code error;
  fs::create_directories(dir, error);
  return dir;
}

constexpr std::size_t kMostRecent = 8;
constexpr std::size_t kLongestSettings = 1 << 20;  // longest settings file [bytes]

fs::path settings_file() { return user_config_dir() / "settings.toml"; }

// Visits every setting but the parameters, for reading and for writing.
template <class S, class Visit>
void each(S& s, Visit&& visit) {
  visit("ui_scale", s.ui_scale);
  visit("text_size", s.text_size);
  visit("width", s.width);
  visit("height", s.height);
  visit("left", s.left);
  visit("right", s.right);
  visit("plots", s.plots);
  visit("everything", s.everything);
  visit("show_left", s.show_left);
  visit("show_right", s.show_right);
  visit("show_plots", s.show_plots);
  visit("show_ghost", s.show_ghost);
  visit("show_trail", s.show_trail);
  visit("show_forces", s.show_forces);
  visit("show_grid", s.show_grid);
  visit("show_lens", s.show_lens);
  visit("show_joints", s.show_joints);
  visit("twin_overlaid", s.overlaid);
  visit("hold_on_release", s.hold_on_release);
  visit("own_file_dialogs", s.own_file_dialogs);
  visit("hint_seen", s.hint_seen);
  visit("your_turn", s.your_turn);
  visit("tried", s.tried);
  visit("picture_quality", s.picture_quality);
  visit("plot_length", s.plot_length);
  visit("band", s.band);
  visit("device", s.device);
  visit("device_tip", s.device_tip);
  visit("scene", s.scene);
  visit("gamepad", s.gamepad);
}

void complain(std::string& complaint, const std::string& why) {
  complaint += fmt::format("{}{}", complaint.empty() ? "the settings were not read: " : "; ", why);
}

void lower(Parameters& p, const std::string& limit, std::string& complaint) {
  const ParameterInfo& info = *find_parameter(limit);
  set_parameter_number(p, info, 0);
  complain(complaint, fmt::format("{} is {} {} until you set another value", limit,
                                  parameter_number(p, info), info.unit));
}

// A limit that a user has lowered stays lowered, even if the file cannot be understood.
void lower_all(Parameters& p, std::string& complaint) {
  for (const char* limit : kMotorLimits) lower(p, limit, complaint);
}

// Lowers a limit as far as possible if its own line is wrong or an unknown key may mean it: nobody
// knows how low it was.
void lower_untaken(Parameters& p, const std::vector<UntakenKey>& untaken, std::string& complaint) {
  const std::vector<std::string> limits(kMotorLimits.begin(), kMotorLimits.end());
  for (const UntakenKey& one : untaken) {
    const bool unknown = find_parameter(one.key) == nullptr;
    const auto meant = unknown ? nearest(one.key, limits) : std::nullopt;
    for (const std::string& limit : limits) {
      const bool within = one.key.empty() || limit.starts_with(one.key + ".");
      if (limit == one.key || limit == meant || within) lower(p, limit, complaint);
    }
  }
}

// Reads key by key: a wrong key costs no other.
void read_parameters(const std::string& text, const char* table, const std::string& where,
                     Parameters& p, std::string& complaint) {
  const std::vector<UntakenKey> untaken = take_config_table(p, text, table, where);
  for (const UntakenKey& one : untaken) complain(complaint, one.why);
  lower_untaken(p, untaken, complaint);
}

// Returns the table of a lane's settings in the file.
std::string table_name(std::size_t lane) {
  return lane == kMainLane ? "parameters" : lane_name(lane);
}

Settings settings_of(const std::string& text, const fs::path& file, std::string& complaint) {
  Settings s;
  try {
    const toml::table table = parse_toml(text, file.string());
    each(s, [&](const char* key, auto& value) {
      using T = std::remove_reference_t<decltype(value)>;
      if (const auto found = table["window"][key].value<T>()) value = *found;
    });
    // A user of an older Limpid, which did not ask yet, needs no hints.
    if (s.hint_seen && !table["window"]["tried"].is_string()) note_all_done(s);
    if (const toml::array* recent = table["window"]["recent"].as_array()) {
      for (const toml::node& node : *recent) {
        if (const auto name = node.value<std::string>()) s.recent.push_back(*name);
      }
    }
    s.text_size = std::clamp(s.text_size, kTextSizes.front(), kTextSizes.back());
    const auto theme = table["window"]["theme"].value_or(std::string());
    const auto* named = std::ranges::find(kThemes, theme);
    if (named != kThemes.end()) s.theme = static_cast<Theme>(named - kThemes.begin());
    for (std::size_t i = 0; i < kMostLanes; ++i) {
      read_parameters(text, table_name(i).c_str(), file.string(), s.lanes.parameters[i], complaint);
    }
    s.parameters().tick = Parameters{}.tick;
    s.parameters().substeps = Parameters{}.substeps;
    try {
      s.plot_choices = plots_of(table, file.string());
    } catch (const std::exception& e) {
      complain(complaint, e.what());
    }
  } catch (const std::exception& e) {
    complain(complaint, e.what());
    lower_all(s.parameters(), complaint);
  }
  return s;
}

toml::table table_of(const Settings& settings) {
  toml::table window;
  each(settings, [&](const char* key, const auto& value) { window.insert(key, value); });
  toml::array recent;
  for (const std::string& name : settings.recent) recent.push_back(name);
  window.insert("recent", recent);
  window.insert("theme", kThemes[static_cast<std::size_t>(settings.theme)]);
  toml::table all;
  all.insert("window", window);
  all.insert("plot", plots_toml(settings.plot_choices));
  for (std::size_t i = 0; i < kMostLanes; ++i) {
    all.insert(table_name(i), toml::parse(config_text(settings.lanes.parameters[i])));
  }
  return all;
}

bool same(const toml::node& a, const toml::node& b) {
  return a.visit([&](const auto& value) {
    const auto* other = dynamic_cast<const std::remove_cvref_t<decltype(value)>*>(&b);
    return other != nullptr && value == *other;
  });
}

// Changes in `there` the values in which `now` differs from `began`.
void put_changes(toml::table& there, const toml::table& now, const toml::table& began) {
  for (const auto& [key, node] : now) {
    const toml::node* before = began.get(key);
    toml::node* present = there.get(key);
    if (node.is_table() && present != nullptr && present->is_table()) {
      const bool known = before != nullptr && before->is_table();
      put_changes(*present->as_table(), *node.as_table(),
                  known ? *before->as_table() : toml::table());
    } else if (present == nullptr || before == nullptr || !same(node, *before)) {
      there.insert_or_assign(key, node);
    }
  }
  for (const auto& [key, node] : began) {
    if (!now.contains(key)) there.erase(key);
  }
}

// Returns this window's newly opened files, then other windows', then those from before.
std::vector<std::string> recent_of_all(const Settings& now, const Settings& began,
                                       const Settings& there) {
  if (there.recent == began.recent) return now.recent;
  const auto in = [](const std::vector<std::string>& list, const std::string& file) {
    return std::ranges::find(list, file) != list.end();
  };
  Settings all;
  const auto add = [&](const std::string& file) {
    if (!in(all.recent, file)) all.recent.push_back(file);
  };
  for (const std::string& file : now.recent) {
    if (!in(began.recent, file)) add(file);
  }
  for (const std::string& file : there.recent) {
    if (!in(began.recent, file)) add(file);
  }
  for (const std::string& file : now.recent) add(file);
  if (all.recent.size() > kMostRecent) all.recent.resize(kMostRecent);
  return all.recent;
}

// Returns the text of a settings file, brought up to date.
std::string text_with(const Settings& settings, const Settings& began, const std::string& text) {
  toml::table all = table_of(settings);
  std::string complaint;
  const Settings there = settings_of(text, settings_file(), complaint);
  if (!complaint.empty()) {
    keep_unread(settings_file());
  } else if (!text.empty()) {
    Settings now = settings;
    now.recent = recent_of_all(settings, began, there);
    all = toml::parse(text);
    put_changes(all, table_of(now), table_of(began));
  }
  std::ostringstream out;
  out << all << '\n';
  return out.str();
}

}  // namespace

toml::array plots_toml(const std::vector<PlotChoice>& plots) {
  toml::array all;
  for (const PlotChoice& plot : plots) {
    toml::table table;
    if (!plot.title.empty()) table.insert("title", plot.title);
    table.insert("kind", name(plot.kind));
    if (!plot.across.empty()) table.insert("across", plot.across);
    toml::array channels;
    for (const std::string& key : plot.channels) channels.push_back(key);
    table.insert("channels", std::move(channels));
    all.push_back(std::move(table));
  }
  return all;
}

std::vector<PlotChoice> plots_of(const toml::table& table, const std::string& where) {
  const TomlTable whole(table, where, "");
  if (whole.find("plot") == nullptr) return default_plots();
  std::vector<PlotChoice> plots;
  for (const TomlTable& each : whole.tables("plot")) plots.push_back(plot_of(each));
  if (plots.size() > kMostPlots) whole.refuse("plot", "at most 24 tables [[plot]]");
  return plots;
}

void remember_recent(Settings& settings, const std::string& file) {
  std::erase(settings.recent, file);
  settings.recent.insert(settings.recent.begin(), file);
  if (settings.recent.size() > kMostRecent) settings.recent.resize(kMostRecent);
}

void show_everything(Settings& settings, bool everything) {
  const auto& [now, then] = everything ? std::pair(simple_plots(), default_plots())
                                       : std::pair(default_plots(), simple_plots());
  if (settings.plot_choices == now) settings.plot_choices = then;
  settings.everything = everything;
}

bool kept_alike(const Settings& a, const Settings& b) { return table_of(a) == table_of(b); }

Settings load_settings(std::string& complaint) {
  const fs::path file = settings_file();
  std::error_code none;
  if (!fs::exists(file, none)) {
    Settings first;
    show_everything(first, false);
    return first;
  }
  try {
    return settings_of(read_text(file, kLongestSettings), file, complaint);
  } catch (const std::exception& e) {
    complain(complaint, e.what());
    Settings s;
    lower_all(s.parameters(), complaint);
    return s;
  }
}

std::string save_settings(const Settings& settings, const Settings& began) {
  try {
    update_file_under_lock(
        settings_file(), [&](const std::string& text) { return text_with(settings, began, text); });
    return {};
  } catch (const std::exception& e) {
    return e.what();
  }
}

fs::path sessions_dir() { return made(user_data_dir() / "sessions"); }
fs::path scenes_dir() { return made(user_data_dir() / "scenes"); }
fs::path sweeps_dir() { return made(user_data_dir() / "sweeps"); }

}  // namespace limpid
