// Pictures from files, as ImGui shows them.
#pragma once

#include <imgui.h>

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "app/style/palette.h"

namespace limpid {

// Turns the lightness of RGBA pixels: white becomes `sheet`, a dark colour, and black white. Hues
// and saturation stay.
void onto_dark(std::span<unsigned char> rgba, Rgb sheet);

// Texture of a picture. Needs a current OpenGL context from construction to destruction.
class PictureTexture {
 public:
  // Reads a picture. `sheet` is the colour of paper for a figure drawn on white. Errors:
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

// Pictures of files in a list, each loaded when it is first asked for.
class PictureShelf {
 public:
  // Returns a picture, or null if it cannot be read. Needs a current OpenGL context.
  const PictureTexture* get(const std::filesystem::path& picture);
  // Drops all pictures: before the OpenGL context goes, or to read them anew.
  void clear() { pictures_.clear(); }

 private:
  std::map<std::filesystem::path, std::optional<PictureTexture>> pictures_;
};

struct PictureItem {
  const PictureTexture* picture;  // may be null
  std::string name, about;        // the two lines of text
  bool there = true;              // otherwise grey, and cannot be chosen
};

// Draws a line of a list with its picture at the left; returns true when it is chosen. `width`
// [px]; 0: all there is. `marked`: the arrow keys are at it.
bool picture_item(const PictureItem& item, float width = 0, bool marked = false);
// Returns the width that the item needs [px].
float picture_item_width(const PictureItem& item);

}  // namespace limpid
