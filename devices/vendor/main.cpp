// limpid-vendor: reaches devices by their makers' libraries, for Limpid, which starts it.
//
//   limpid-vendor list [--simulator]                 says a line of JSON for each library, device
//   limpid-vendor BACKEND NAME --socket PATH         serves the device on a socket
//   limpid-vendor BACKEND NAME --connection NUMBER         serves it on a connection handed over
//   limpid-vendor BACKEND NAME --calibrate                 lets the device find its zero, by itself
//
// The makers' threads, prints and crashes stay in this program. Everything that they print goes to
// standard error.
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "core/base/descriptor.h"
#include "devices/hid/device_claim.h"
#include "devices/hid/hid_transport.h"
#include "devices/hid/raw_device.h"
#include "devices/vendor/vendor_server.h"

namespace limpid {
namespace {

using nlohmann::ordered_json;

constexpr unsigned kLongestList = 5, kLongestOpen = 30;  // [s]; then the process ends

struct Words {
  std::string back_end, name;
  VendorOptions options;
  ServerPlace place;
  bool calibrate = false;
};

struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

constexpr const char* kUsage =
    "allowed: limpid-vendor list [--simulator], or limpid-vendor BACKEND NAME --socket PATH "
    "[--simulator] [--calibrate]";

Words read_words(const std::vector<std::string>& words) {
  Words read;
  std::vector<std::string> plain;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool another = i + 1 < words.size();
    if (words[i] == "--simulator") {
      read.options.simulator = true;
    } else if (words[i] == "--calibrate") {
      read.calibrate = true;
    } else if (words[i] == "--socket" && another) {
      read.place.socket = words[++i];
    } else if (words[i] == "--connection" && another) {
      const std::string& number = words[++i];
      std::from_chars(number.data(), number.data() + number.size(), read.place.connection);
    } else {
      plain.push_back(words[i]);
    }
  }
  const bool lists = plain.size() == 1 && plain[0] == "list";
  const bool somewhere = !read.place.socket.empty() || read.place.connection >= 0 || read.calibrate;
  if (!lists && (plain.size() != 2 || !somewhere)) throw UsageError(kUsage);
  read.back_end = plain[0];
  if (!lists) read.name = plain[1];
  return read;
}

// Keeps the real standard output, and gives standard error to whoever prints from now on.
int keep_standard_output() {
  const int kept = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 10);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
  return kept;
}

void print_line(int to, const ordered_json& line) {
  const std::string text = line.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
  write_all(to, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

// Whether a device of these makers is plugged in.
bool on_usb(const std::vector<std::uint16_t>& vendors) {
  std::error_code none;
  for (std::filesystem::directory_iterator entry("/sys/bus/usb/devices", none), end;
       !none && entry != end; entry.increment(none)) {
    unsigned vendor = 0;
    std::ifstream(entry->path() / "idVendor") >> std::hex >> vendor;
    if (std::ranges::find(vendors, vendor) != vendors.end()) return true;
  }
  return false;
}

void list_one(const BackEndEntry& entry, const VendorOptions& options, int to) {
  const auto device = entry.make();
  try {
    const VendorLibrary library = device->load();
    print_line(to, {{"backend", entry.key},
                    {"library", library.path},
                    {"version", library.version},
                    {"missing", ""},
                    {"absent", false}});
    for (const VendorListed& each : device->list(options)) {
      print_line(to, {{"backend", entry.key},
                      {"device", each.name},
                      {"title", each.title},
                      {"missing", each.missing}});
    }
  } catch (const std::exception& error) {
    print_line(to, {{"backend", entry.key},
                    {"library", ""},
                    {"missing", error.what()},
                    {"absent", dynamic_cast<const VendorAbsent*>(&error) != nullptr}});
    if (!on_usb(entry.usb)) return;
    print_line(to, {{"backend", entry.key},
                    {"device", ""},
                    {"title", fmt::format("a device of {}", entry.maker)},
                    {"missing", error.what()}});
  }
}

// Each library is asked in a process of its own: one that crashes hides no other.
int list(const VendorOptions& options, int to) {
  for (const BackEndEntry& entry : back_ends()) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::alarm(kLongestList);
      list_one(entry, options, to);
      ::_exit(0);
    }
    int status = 0;
    while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (child > 0 && status == 0) continue;
    const bool silent = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM;
    const std::string missing =
        fmt::format("the library of {} {}", entry.maker,
                    silent ? "does not return" : "crashes when it is loaded");
    print_line(to,
               {{"backend", entry.key}, {"library", ""}, {"missing", missing}, {"absent", false}});
  }
  return 0;
}

// Lets the device find its zero. Signals end the process meanwhile, and so the motion.
void find_zero(VendorBackEnd& device, const std::string& moves) {
  std::fputs(fmt::format("limpid-vendor: {}.\n", moves).c_str(), stderr);
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_UNBLOCK, &all, &before);
  ::alarm(0);
  device.calibrate();
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

DeviceClaim claimed(const std::string& name, const std::string& key) {
  try {
    return DeviceClaim(key);
  } catch (const HidError& error) {
    throw VendorError(fmt::format("{}: {}", name, error.what()));
  }
}

void open_and_serve(const Words& words) {
  const auto found = std::ranges::find_if(
      back_ends(), [&](const BackEndEntry& entry) { return words.back_end == entry.key; });
  if (found == back_ends().end()) {
    throw UsageError(fmt::format("\"{}\" is not a back end; {}", words.back_end, kUsage));
  }
  hold_signals();
  ::alarm(kLongestOpen);
  const auto device = found->make();
  const VendorLibrary library = device->load();
  // Limpid holds the claim of a device that it starts this program for, and hands it over.
  DeviceClaim by_name, by_serial;
  if (words.place.connection < 0) {
    by_name = claimed(words.name, vendor_claim_key(words.back_end, words.name));
  }
  const VendorTraits traits = device->open(words.name, words.options);
  std::fputs(
      fmt::format("limpid-vendor: {}, by {} ({})\n", traits.name, traits.made_by, library.path)
          .c_str(),
      stderr);
  try {
    // A device may have several names.
    if (!traits.serial.empty()) {
      by_serial = claimed(traits.name, "vendor-serial:" + words.back_end + ":" + traits.serial);
    }
    if (const std::string moves = device->needs_calibration(); !moves.empty()) {
      if (!words.calibrate) {
        throw VendorError(fmt::format("{}. Then run: limpid-vendor {} {} --calibrate", moves,
                                      words.back_end, words.name));
      }
      find_zero(*device, moves);
    }
    ::alarm(0);
    const ServerPlace& place = words.place;
    if (place.socket.empty() && place.connection < 0) return device->close();
    serve(*device, traits, place);
  } catch (const std::exception&) {
    device->close();
    throw;
  }
}

// Tells the other end of a connection why it gets no device.
void refuse(int connection, const std::string& why) {
  const std::string packet = kRefusal + why;
  if (connection >= 0) ::send(connection, packet.data(), packet.size(), MSG_NOSIGNAL);
}

int run(const std::vector<std::string>& all) {
  const int output = keep_standard_output();
  ::signal(SIGPIPE, SIG_IGN);
  sigset_t alarm_alone;
  sigemptyset(&alarm_alone);
  sigaddset(&alarm_alone, SIGALRM);
  ::pthread_sigmask(SIG_UNBLOCK, &alarm_alone, nullptr);  // whatever Limpid's thread holds back
  Words words;
  try {
    words = read_words(all);
    if (words.back_end == "list") return list(words.options, output);
    open_and_serve(words);
    return 0;
  } catch (const UsageError& error) {
    std::fputs(fmt::format("limpid-vendor: {}\n", error.what()).c_str(), stderr);
    return 2;
  } catch (const std::exception& error) {
    std::fputs(fmt::format("limpid-vendor: {}\n", error.what()).c_str(), stderr);
    refuse(words.place.connection, error.what());
    return 1;
  }
}

}  // namespace
}  // namespace limpid

int main(int count, char** words) {
  return limpid::run(std::vector<std::string>(words + 1, words + count));
}
