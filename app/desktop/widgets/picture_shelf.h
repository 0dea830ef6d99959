// A picture from a file, as ImGui shows it.
#pragma once

#include <imgui.h>

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "app/style/palette.h"

namespace limpid {

// Pixels of four bytes: what was white becomes `sheet`, a dark colour, what was black white; hues
// and saturation stay.
void onto_dark(std::span<unsigned char> rgba, Rgb sheet);

// Needs a current OpenGL context from construction to destruction.
class PictureTexture {
 public:
  // On `sheet` a figure that was drawn on white paper lies on paper of that colour. Errors:
  // std::runtime_error naming a file that is missing or no picture.
  explicit PictureTexture(const std::filesystem::path& file, std::optional<Rgb> sheet = {});
  ~PictureTexture();
  PictureTexture(PictureTexture&& other) noexcept;
  PictureTexture& operator=(PictureTexture&& other) noexcept;

  ImTextureID id() const;
  float width() const { return static_cast<float>(width_); }    // [px]
  float height() const { return static_cast<float>(height_); }  // [px]

 private:
  unsigned texture_ = 0;
  int width_ = 0, height_ = 0;
};

// Pictures of files that are shown in a list, loaded when they are first asked for.
class PictureShelf {
 public:
  // Null where there is none that can be read. Needs a current OpenGL context.
  const PictureTexture* get(const std::filesystem::path& picture);
  // Before the OpenGL context goes, and to have them read anew.
  void clear() { pictures_.clear(); }

 private:
  std::map<std::filesystem::path, std::optional<PictureTexture>> pictures_;
};

struct PictureItem {
  const PictureTexture* picture;  // or null
  std::string name, about;        // two lines
  bool there = true;              // else greyed, and not to be chosen
};

// A line of a list with its picture at the left; true when it is chosen. `width` [px]; 0: all there
// is. `marked`: the keys are at it.
bool picture_item(const PictureItem& item, float width = 0, bool marked = false);
// What it takes [px].
float picture_item_width(const PictureItem& item);

}  // namespace limpid
