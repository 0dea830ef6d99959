// Which plots the window shows, one after the other or as a layout that has a name.
#pragma once

#include <string>

#include "app/desktop/base/named_texts.h"
#include "app/desktop/base/notices.h"
#include "app/desktop/base/settings.h"
#include "app/desktop/shell/dialogs.h"

namespace limpid {

class PlotLayout {
 public:
  PlotLayout(Settings& settings, Notices& notices, OpenDialog& dialog);

  // A new plot, or another one in its place, is chosen in a dialog.
  void add();
  void choose(std::size_t plot);
  std::size_t chosen() const { return chosen_; }
  void remove(std::size_t plot);
  void use(const std::string& name);  // a layout

  NamedTexts layouts;

 private:
  Settings& settings_;
  Notices& notices_;
  OpenDialog& dialog_;
  std::size_t chosen_ = 0;
};

}  // namespace limpid
