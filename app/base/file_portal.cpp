#include "app/base/file_portal.h"

#include <dbus/dbus.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <mutex>
#include <random>
#include <string_view>
#include <thread>
#include <utility>

#include "app/base/session_bus.h"

namespace limpid {

namespace fs = std::filesystem;

using Clock = std::chrono::steady_clock;

constexpr auto kAnswerWithin = std::chrono::seconds(1);

struct FilePortal::Talk {
  const Clock::time_point began = Clock::now();
  std::mutex mutex;
  State state = State::asked;
  fs::path file;
  bool left = false;  // nobody waits for the answer any more

  // Changes the state; a question that has ended stays as it is.
  void become(State next, const fs::path& answer = {}) {
    const std::scoped_lock lock(mutex);
    if (state != State::asked && state != State::shown) return;
    state = next;
    file = answer;
  }
  State now() {
    const std::scoped_lock lock(mutex);
    if (state == State::asked && Clock::now() - began > kAnswerWithin) state = State::absent;
    return state;
  }
  bool over() {
    const State last = now();
    const std::scoped_lock lock(mutex);
    return left || last == State::absent;
  }
};

namespace {

using State = FilePortal::State;
using Question = FilePortal::Question;

constexpr const char* kPortal = "org.freedesktop.portal.Desktop";
constexpr const char* kPortalPath = "/org/freedesktop/portal/desktop";
constexpr const char* kChooser = "org.freedesktop.portal.FileChooser";
constexpr const char* kRequest = "org.freedesktop.portal.Request";
constexpr auto kCloseWithin = std::chrono::seconds(30);  // later dialogs are closed
constexpr int kLook = 50;  // interval of looks whether the question goes on [ms]

// A map from names to values, "a{sv}", at the end of a message.
class BusOptions {
 public:
  explicit BusOptions(DBusMessageIter& end) : end_(end) {
    dbus_message_iter_open_container(&end, DBUS_TYPE_ARRAY, "{sv}", &all_);
  }
  ~BusOptions() { dbus_message_iter_close_container(&end_, &all_); }
  BusOptions(const BusOptions&) = delete;
  BusOptions& operator=(const BusOptions&) = delete;

  void text(const char* name, const std::string& value) {
    if (dbus_validate_utf8(value.c_str(), nullptr) == FALSE) return;
    const char* const data = value.c_str();
    add(name, "s",
        [&](DBusMessageIter& at) { dbus_message_iter_append_basic(&at, DBUS_TYPE_STRING, &data); });
  }
  // Adds a path with the zero byte at its end, as the portal wants it.
  void path(const char* name, const fs::path& value) {
    const std::string bytes = value.string();
    const char* const data = bytes.c_str();
    add(name, "ay", [&](DBusMessageIter& at) {
      inside(at, DBUS_TYPE_ARRAY, "y", [&](DBusMessageIter& array) {
        dbus_message_iter_append_fixed_array(&array, DBUS_TYPE_BYTE, &data,
                                             static_cast<int>(bytes.size() + 1));
      });
    });
  }
  // Adds one filter: its name, and the patterns of the files that it lets through.
  void filter(const char* name, const std::string& label,
              const std::vector<std::string>& patterns) {
    add(name, "a(sa(us))", [&](DBusMessageIter& at) {
      inside(at, DBUS_TYPE_ARRAY, "(sa(us))", [&](DBusMessageIter& filters) {
        inside(filters, DBUS_TYPE_STRUCT, nullptr, [&](DBusMessageIter& filter) {
          const char* const data = label.c_str();
          dbus_message_iter_append_basic(&filter, DBUS_TYPE_STRING, &data);
          inside(filter, DBUS_TYPE_ARRAY, "(us)", [&](DBusMessageIter& list) {
            for (const std::string& pattern : patterns) add_pattern(list, pattern);
          });
        });
      });
    });
  }

 private:
  template <class Fill>
  static void inside(DBusMessageIter& at, int type, const char* signature, Fill&& fill) {
    DBusMessageIter in;
    dbus_message_iter_open_container(&at, type, signature, &in);
    fill(in);
    dbus_message_iter_close_container(&at, &in);
  }
  template <class Fill>
  void add(const char* name, const char* signature, Fill&& fill) {
    inside(all_, DBUS_TYPE_DICT_ENTRY, nullptr, [&](DBusMessageIter& entry) {
      dbus_message_iter_append_basic(&entry, DBUS_TYPE_STRING, &name);
      inside(entry, DBUS_TYPE_VARIANT, signature, fill);
    });
  }
  static void add_pattern(DBusMessageIter& list, const std::string& pattern) {
    inside(list, DBUS_TYPE_STRUCT, nullptr, [&](DBusMessageIter& one) {
      const dbus_uint32_t glob = 0;
      const char* const data = pattern.c_str();
      dbus_message_iter_append_basic(&one, DBUS_TYPE_UINT32, &glob);
      dbus_message_iter_append_basic(&one, DBUS_TYPE_STRING, &data);
    });
  }

  DBusMessageIter& end_;
  DBusMessageIter all_;
};

// Turns ".stl" into "*.[sS][tT][lL]": portals tell capitals from small letters.
std::string pattern_of(const std::string& extension) {
  std::string pattern = "*";
  for (const char c : extension) {
    const auto byte = static_cast<unsigned char>(c);
    pattern += std::isalpha(byte) == 0
                   ? std::string(1, c)
                   : fmt::format("[{}{}]", static_cast<char>(std::tolower(byte)),
                                 static_cast<char>(std::toupper(byte)));
  }
  return pattern;
}

BusMessage call_for(const Question& question, const std::string& token) {
  BusMessage call(dbus_message_new_method_call(kPortal, kPortalPath, kChooser,
                                               question.new_file ? "SaveFile" : "OpenFile"));
  DBusMessageIter end;
  dbus_message_iter_init_append(call.get(), &end);
  for (const std::string* text : {&question.parent, &question.title}) {
    const char* const data = text->c_str();
    dbus_message_iter_append_basic(&end, DBUS_TYPE_STRING, &data);
  }
  BusOptions options(end);
  options.text("handle_token", token);
  options.text("accept_label", question.action);
  std::string label;
  std::vector<std::string> patterns;
  for (const std::string& extension : question.extensions) {
    label += (label.empty() ? "*" : ", *") + extension;
    patterns.push_back(pattern_of(extension));
  }
  options.filter("filters", label, patterns);
  options.path("current_folder", question.first.parent_path());
  if (question.new_file) options.text("current_name", question.first.filename().string());
  return call;
}

// Makes a token that nobody else may guess.
std::string new_token() {
  std::random_device random;
  return fmt::format("limpid_{:08x}{:08x}", random(), random());
}

// Returns the request's path before it exists, so that its answer cannot be missed.
std::string handle_of(DBusConnection* bus, const std::string& token) {
  std::string sender = dbus_bus_get_unique_name(bus);
  std::erase(sender, ':');
  std::ranges::replace(sender, '.', '_');
  return fmt::format("{}/request/{}/{}", kPortalPath, sender, token);
}

void listen_to(DBusConnection* bus, const std::string& handle) {
  const std::string rule =
      fmt::format("type='signal',interface='{}',member='Response',path='{}'", kRequest, handle);
  dbus_bus_add_match(bus, rule.c_str(), nullptr);
}

// Returns the first file of the "uris" among the results of an answer.
std::optional<fs::path> chosen_in(DBusMessageIter results) {
  if (dbus_message_iter_get_arg_type(&results) != DBUS_TYPE_ARRAY) return std::nullopt;
  DBusMessageIter entry;
  for (dbus_message_iter_recurse(&results, &entry);
       dbus_message_iter_get_arg_type(&entry) == DBUS_TYPE_DICT_ENTRY;
       dbus_message_iter_next(&entry)) {
    DBusMessageIter pair, value, uris;
    const char* name = nullptr;
    dbus_message_iter_recurse(&entry, &pair);
    if (dbus_message_iter_get_arg_type(&pair) != DBUS_TYPE_STRING) return std::nullopt;
    dbus_message_iter_get_basic(&pair, &name);
    if (std::string_view(name) != "uris" || dbus_message_iter_next(&pair) == FALSE) continue;
    if (dbus_message_iter_get_arg_type(&pair) != DBUS_TYPE_VARIANT) return std::nullopt;
    dbus_message_iter_recurse(&pair, &value);
    if (dbus_message_iter_get_arg_type(&value) != DBUS_TYPE_ARRAY) return std::nullopt;
    dbus_message_iter_recurse(&value, &uris);
    if (dbus_message_iter_get_arg_type(&uris) != DBUS_TYPE_STRING) return std::nullopt;
    const char* uri = nullptr;
    dbus_message_iter_get_basic(&uris, &uri);
    return file_of(uri);
  }
  return std::nullopt;
}

// A question, from asking to its answer, on a thread of its own.
class Conversation {
 public:
  Conversation(FilePortal::Talk& talk, const Question& question)
      : talk_(talk), bus_(session_bus()) {
    if (!bus_) return;
    const std::string token = new_token();
    handle_ = handle_of(bus_.get(), token);
    listen_to(bus_.get(), handle_);
    const std::string owner =
        fmt::format("type='signal',sender='{}',member='NameOwnerChanged',arg0='{}'",
                    DBUS_SERVICE_DBUS, kPortal);
    dbus_bus_add_match(bus_.get(), owner.c_str(), nullptr);
    dbus_connection_send(bus_.get(), call_for(question, token).get(), &serial_);
  }

  void hold() {
    while (bus_ && !over_ && dbus_connection_read_write(bus_.get(), kLook) == TRUE) {
      while (const BusMessage message{dbus_connection_pop_message(bus_.get())}) hear(message.get());
      if (answered_ && talk_.over()) close();
      if (!answered_ && Clock::now() - talk_.began > kCloseWithin) over_ = true;
    }
    talk_.become(State::absent);
  }

 private:
  void hear(DBusMessage* message) {
    if (dbus_message_get_reply_serial(message) == serial_) {
      hear_reply(message);
    } else if (dbus_message_is_signal(message, kRequest, "Response") == TRUE &&
               dbus_message_has_path(message, handle_.c_str()) == TRUE) {
      hear_answer(message);
    } else if (dbus_message_is_signal(message, DBUS_INTERFACE_DBUS, "NameOwnerChanged") == TRUE) {
      const char *name = nullptr, *before = nullptr, *now = nullptr;
      over_ |= dbus_message_get_args(message, nullptr, DBUS_TYPE_STRING, &name, DBUS_TYPE_STRING,
                                     &before, DBUS_TYPE_STRING, &now, DBUS_TYPE_INVALID) == TRUE &&
               std::string_view(name) == kPortal && *now == '\0';
    }
  }

  // Hears the reply: old portals choose a handle of their own.
  void hear_reply(DBusMessage* message) {
    const char* handle = nullptr;
    over_ |= dbus_message_get_args(message, nullptr, DBUS_TYPE_OBJECT_PATH, &handle,
                                   DBUS_TYPE_INVALID) == FALSE;
    if (over_) return;
    answered_ = true;
    if (handle_ != handle) listen_to(bus_.get(), handle_ = handle);
    talk_.become(State::shown);
  }

  // Hears the answer. 0: chosen; 1: given up; 2: ended in another way, such as by a failed part of
  // the desktop.
  void hear_answer(DBusMessage* message) {
    DBusMessageIter at;
    dbus_uint32_t how = 2;
    over_ = true;
    if (dbus_message_iter_init(message, &at) == FALSE ||
        dbus_message_iter_get_arg_type(&at) != DBUS_TYPE_UINT32) {
      return;
    }
    dbus_message_iter_get_basic(&at, &how);
    if (how == 1) talk_.become(State::given_up);
    if (how != 0 || dbus_message_iter_next(&at) == FALSE) return;
    if (const auto file = chosen_in(at)) talk_.become(State::chosen, *file);
  }

  void close() {
    const BusMessage call(
        dbus_message_new_method_call(kPortal, handle_.c_str(), kRequest, "Close"));
    dbus_message_set_no_reply(call.get(), TRUE);
    dbus_connection_send(bus_.get(), call.get(), nullptr);
    dbus_connection_flush(bus_.get());
    over_ = true;
  }

  FilePortal::Talk& talk_;
  const Bus bus_;
  std::string handle_;
  dbus_uint32_t serial_ = 0;
  bool answered_ = false, over_ = false;
};

}  // namespace

// Asks on a thread that ends by itself: it may have to wait for a bus that does not answer.
FilePortal::FilePortal(Question question) : talk_(std::make_shared<Talk>()) {
  std::thread([talk = talk_, question = std::move(question)] {
    Conversation(*talk, question).hold();
  }).detach();
}

FilePortal::~FilePortal() {
  const std::scoped_lock lock(talk_->mutex);
  talk_->left = true;
}

FilePortal::State FilePortal::state() const { return talk_->now(); }

fs::path FilePortal::file() const {
  const std::scoped_lock lock(talk_->mutex);
  return talk_->file;
}

std::optional<unsigned> file_portal_version() {
  const Bus bus = session_bus();
  if (!bus) return std::nullopt;
  const BusMessage call(
      dbus_message_new_method_call(kPortal, kPortalPath, DBUS_INTERFACE_PROPERTIES, "Get"));
  const char* const chooser = kChooser;
  const char* const version = "version";
  dbus_message_append_args(call.get(), DBUS_TYPE_STRING, &chooser, DBUS_TYPE_STRING, &version,
                           DBUS_TYPE_INVALID);
  constexpr int kWithin = std::chrono::milliseconds(kAnswerWithin).count();
  const BusMessage answer(
      dbus_connection_send_with_reply_and_block(bus.get(), call.get(), kWithin, nullptr));
  DBusMessageIter at, value;
  if (!answer || dbus_message_iter_init(answer.get(), &at) == FALSE ||
      dbus_message_iter_get_arg_type(&at) != DBUS_TYPE_VARIANT) {
    return std::nullopt;
  }
  dbus_message_iter_recurse(&at, &value);
  if (dbus_message_iter_get_arg_type(&value) != DBUS_TYPE_UINT32) return std::nullopt;
  dbus_uint32_t number = 0;
  dbus_message_iter_get_basic(&value, &number);
  return number;
}

}  // namespace limpid
