// Which end of an arm is meant, where it branches.
#pragma once

#include <string>

#include "devices/files/urdf_file.h"

namespace limpid {

class TipQuestion {
 public:
  // While `open`. The link, once it is chosen; that clears `open`.
  std::string draw(bool& open, const TipsToChoose& choice);

 private:
  std::size_t chosen_ = 0;
  bool was_open_ = false;
};

}  // namespace limpid
