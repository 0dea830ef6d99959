// The units that a model's coordinates may be in.
#pragma once

#include <array>
#include <cctype>
#include <filesystem>
#include <string>

namespace limpid {

struct ModelUnit {
  const char* name;  // in scene files
  double metres;
};

inline constexpr std::array kModelUnits{ModelUnit{"m", 1}, ModelUnit{"cm", 0.01},
                                        ModelUnit{"mm", 0.001}, ModelUnit{"in", 0.0254},
                                        ModelUnit{"ft", 0.3048}};

// Null for what is none of them.
inline const ModelUnit* model_unit(double metres) {
  for (const ModelUnit& each : kModelUnits) {
    if (each.metres == metres) return &each;
  }
  return nullptr;
}

// The suffix of a file in small letters, with its dot.
inline std::string small_suffix(const std::filesystem::path& file) {
  std::string suffix = file.extension().string();
  for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return suffix;
}

// Where a scene does not say the unit [m]: STL knows none, but what makes such files thinks in
// millimetres.
inline double usual_unit(const std::filesystem::path& file) {
  return small_suffix(file) == ".stl" ? 0.001 : 1;
}

}  // namespace limpid
