#include "app/story/camera_words.h"

#include <fmt/format.h>

#include <algorithm>

namespace limpid {
namespace {

constexpr std::array<const char*, 4> kViews{"front", "top", "side", "iso"};
constexpr Range kMetres{-10, 10, false, "m"};

Camera::View view_in(const TomlTable& table, const char* key) {
  const std::string word = table.need(table.text(key), key);
  const auto at = std::ranges::find(kViews, word);
  if (at == kViews.end()) table.refuse(key, fmt::format("{}", fmt::join(kViews, ", ")));
  return static_cast<Camera::View>(at - kViews.begin());
}

}  // namespace

const char* view_word(Camera::View view) { return kViews[static_cast<std::size_t>(view)]; }

std::optional<StoryCamera> camera_said(const TomlTable& step, const std::string& where) {
  const toml::node* node = step.find("camera");
  if (node == nullptr) return std::nullopt;
  if (node->is_string()) return StoryCamera{view_in(step, "camera")};
  if (!node->is_table()) {
    step.refuse("camera", "a view, or { view = \"side\", target = [x, y, z], size = 0.2 }");
  }
  const TomlTable table(*node->as_table(), where, "step.camera");
  table.allow_only({"view", "target", "size"});
  const Vec3 target = table.need(table.vector("target", kMetres), "target");
  const double size = table.need(table.number("size", {0.01, 10, false, "m"}), "size");
  return StoryCamera{view_in(table, "view"),
                     Bounds(target - Vec3::Constant(size / 2), target + Vec3::Constant(size / 2))};
}

std::optional<std::array<std::string, 2>> names_said(const TomlTable& step) {
  const toml::node* node = step.find("names");
  if (node == nullptr) return std::nullopt;
  const toml::array* list = node->as_array();
  const bool good = list != nullptr && list->size() == 2 && list->get(0)->is_string() &&
                    list->get(1)->is_string();
  if (!good) step.refuse("names", "two words, as [\"left\", \"right\"]");
  return std::array{*list->get(0)->value<std::string>(), *list->get(1)->value<std::string>()};
}

bool flag_in(const TomlTable& step, const char* key, bool otherwise) {
  const toml::node* node = step.find(key);
  if (node == nullptr) return otherwise;
  const auto said = node->value_exact<bool>();
  if (!said) step.refuse(key, "true, false");
  return *said;
}

}  // namespace limpid
