#include "app/window_keys.h"

#include "app/desktop/shell/command_keys.h"
#include "app/desktop/shell/commands.h"
#include "app/desktop/shell/key_labels.h"

namespace limpid {

std::vector<ManualKey> keys_of_window() {
  std::vector<ManualKey> keys;
  for (const Shortcut& each : shortcuts(KeyLabels())) {
    keys.push_back({std::string(each.group), each.keys, each.what});
  }
  return keys;
}

}  // namespace limpid
