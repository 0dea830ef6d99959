// Fuzzes requests on the control socket: any line gives a request with a verb of the table and its
// keys, or an error of one line. A setting that it changes is one that a loop can have, within the
// limits.
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>

#include "app/remote/protocol.h"
#include "app/remote/remote_settings.h"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

void check_message(const std::string& text) {
  demand(!text.empty() && text.find('\n') == std::string::npos);
}

// Reads the keys as Remote does, in every way that a request can ask for.
void read_keys(const limpid::Request& request) {
  const limpid::Keys keys(request);
  for (const char* key : request.verb->keys) {
    const auto attempt = [](auto&& read) {
      try {
        read();
      } catch (const limpid::RemoteError& e) {
        check_message(e.what());
      }
    };
    attempt([&] { demand(keys.text_if(key).value_or("x").size() <= limpid::Keys::kLongestText); });
    attempt(
        [&] { demand(keys.texts_if(key, 9).value_or(std::vector<std::string>()).size() <= 9); });
    attempt([&] {
      const double x = keys.number_or(key, 1, 0, 2);
      demand(x >= 0 && x <= 2);
    });
    attempt([&] { keys.flag_or(key, true); });
  }
}

void set_values(const limpid::Request& request) {
  const auto found = request.keys.find("values");
  if (found == request.keys.end() || !found->is_object()) return;
  limpid::Parameters highest;
  highest.torque_limit = 1;
  limpid::Parameters p = highest;
  for (const auto& [key, value] : found->items()) {
    try {
      limpid::set_by_remote(p, key, value, highest);
    } catch (const limpid::RemoteError& e) {
      check_message(e.what());
    } catch (const limpid::ParameterError& e) {
      demand(e.what() != nullptr);
    }
    demand(p.torque_limit <= highest.torque_limit && p.energy <= highest.energy);
    demand(std::isfinite(p.eta) && p.eta > 0 && p.tick == highest.tick);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  nlohmann::json id;
  limpid::asks_for_cut(line);
  try {
    const limpid::Request request = limpid::read_request(line, id);
    demand(limpid::find_verb(request.verb->name) == request.verb && request.keys.is_object());
    read_keys(request);
    set_values(request);
    demand(nlohmann::json::parse(limpid::answer_line(id, request.keys))["ok"].is_object());
  } catch (const limpid::RemoteError& e) {
    check_message(e.what());
    demand(nlohmann::json::parse(limpid::error_line(id, e.what()))["id"] == id);
  }
  return 0;
}
