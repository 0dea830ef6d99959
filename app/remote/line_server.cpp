#include "app/remote/line_server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/listening_socket.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kLongestName = 64;
constexpr std::size_t kPiece = std::size_t{16} << 10;  // bytes read at once
constexpr std::size_t kLongestOwner = 200;
constexpr std::size_t kMostEvents = 1024;  // for the owner; with more, no new client is accepted
// Pause for the owner after a turn that left lines waiting. Else a client that floods would have
// the lock taken again before the owner gets it.
constexpr std::chrono::milliseconds kBreath{1};
constexpr mode_t kFolderMode = 0700, kFileMode = 0600;

ListenError failed(const fs::path& path) {
  return ListenError(fmt::format("{}: {}", path.string(), std::strerror(errno)));
}

// Makes the folder private, whatever the umask and the owner.
void make_private(const fs::path& folder) {
  if (mkdir(folder.c_str(), kFolderMode) != 0 && errno != EEXIST) throw failed(folder);
  struct stat is {};
  if (lstat(folder.c_str(), &is) != 0) throw failed(folder);
  if (!S_ISDIR(is.st_mode) || is.st_uid != geteuid()) {
    throw ListenError(
        fmt::format("{}: must be a folder of the user who starts the program", folder.string()));
  }
  if ((is.st_mode & 0777) != kFolderMode && chmod(folder.c_str(), kFolderMode) != 0) {
    throw failed(folder);
  }
}

std::string own_words() {
  std::string words;
  const int file = open("/proc/self/cmdline", O_RDONLY | O_CLOEXEC);
  std::array<char, kLongestOwner> bytes{};
  const ssize_t size = file >= 0 ? ::read(file, bytes.data(), bytes.size()) : 0;
  if (file >= 0) close(file);
  for (ssize_t i = 0; i < size; ++i) {
    const char c = bytes[static_cast<std::size_t>(i)];
    words += c == '\0' ? ' ' : (c >= 0x20 && c < 0x7F) ? c : '?';
  }
  while (words.ends_with(' ')) words.pop_back();
  return words.substr(words.substr(0, words.find(' ')).rfind('/') + 1);
}

// The program that has a name, by its words in the lock's file.
std::string owner_in(int lock) {
  std::array<char, kLongestOwner + 40> bytes{};
  const ssize_t size = pread(lock, bytes.data(), bytes.size(), 0);
  return size > 0 ? std::string(bytes.data(), static_cast<std::size_t>(size)) : "another program";
}

// Returns the address of a socket's path. Errors: ListenError.
sockaddr_un address_of(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string text = path.string();
  if (text.size() >= sizeof(address.sun_path)) {
    throw ListenError(fmt::format("{}: a socket's path has at most {} characters", text,
                                  sizeof(address.sun_path) - 1));
  }
  text.copy(address.sun_path, text.size());
  return address;
}

// Returns whether a program listens on a socket.
bool somebody_listens(const sockaddr_un& address) {
  const Descriptor file(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  return connect(*file, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0 ||
         (errno != ECONNREFUSED && errno != ENOENT);
}

// Takes the lock, which ends with the process in any case; the file stays. Where the system has no
// locks, the socket itself says whether a program uses it.
int take_lock(const fs::path& path, const sockaddr_un& address) {
  const fs::path file = path.string() + ".lock";
  const int lock = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kFileMode);
  if (lock < 0) throw failed(file);
  const int code = flock(lock, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
  if (code != 0 && code != EWOULDBLOCK && !has_no_locks(code)) {
    close(lock);
    errno = code;
    throw failed(file);
  }
  if (code == EWOULDBLOCK || (code != 0 && somebody_listens(address))) {
    const std::string owner = owner_in(lock);
    close(lock);
    throw ListenError(
        fmt::format("{}: {} uses this socket already; choose another name", path.string(), owner));
  }
  const std::string owner = fmt::format("process {} ({})", getpid(), own_words());
  if (ftruncate(lock, 0) != 0 || pwrite(lock, owner.data(), owner.size(), 0) < 0) {
    const ListenError error = failed(file);
    close(lock);
    throw error;
  }
  return lock;
}

bool says_something(std::string_view line) {
  return line.find_first_not_of(" \t\r") != std::string_view::npos;
}

}  // namespace

fs::path control_path(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
           c == '_';
  };
  if (name.empty() || name.size() > kLongestName || !std::ranges::all_of(name, plain)) {
    throw ListenError(
        fmt::format("\"{}\": is not allowed as a name; allowed: letters, digits, - and _, up to {}",
                    name.substr(0, kLongestName), kLongestName));
  }
  const char* folder = std::getenv("XDG_RUNTIME_DIR");
  if (folder == nullptr || *folder != '/') {
    throw ListenError(
        "XDG_RUNTIME_DIR is not set: there is no folder for a socket. Set it to a folder that only "
        "you can read, usually /run/user/UID");
  }
  return fs::path(folder) / "limpid" / (name + ".control");
}

ControlSocket::ControlSocket(const fs::path& path) : path_(path) {
  make_private(path.parent_path());
  lock_ = take_lock(path, address_of(path));
  file_ = listen_under(path, SOCK_STREAM, static_cast<int>(LineServer::kMostClients));
  if (file_ >= 0) return;
  const ListenError error = failed(path);
  close(lock_);
  throw error;
}

ControlSocket::~ControlSocket() {
  unlink(path_.c_str());
  close(file_);
  close(lock_);
}

LineServer::LineServer(const fs::path& path, std::function<void(std::string_view)> at_once)
    : socket_(path), at_once_(std::move(at_once)), wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (wake_ < 0) throw failed(path);
  thread_ = std::thread([this] { live(); });
}

LineServer::~LineServer() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  wake();
  thread_.join();
  for (auto& [id, c] : connections_) close(c.file);
  close(wake_);
}

void LineServer::wake() const {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(wake_, &one, sizeof(one));
}

std::size_t LineServer::clients() const {
  const std::lock_guard lock(mutex_);
  return connections_.size();
}

std::optional<LineServer::Event> LineServer::take() {
  const std::lock_guard lock(mutex_);
  if (events_.empty()) return std::nullopt;
  Event event = std::move(events_.front());
  events_.pop_front();
  return event;
}

void LineServer::wait_until(Clock::time_point end) {
  std::unique_lock lock(mutex_);
  happened_.wait_until(lock, end, [this] { return !events_.empty(); });
}

void LineServer::answer(Client to, std::string_view line) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = connections_.find(to);
    if (found == connections_.end()) return;
    Connection& c = found->second;
    if (c.unanswered > 0) --c.unanswered;
    c.out.append(line).push_back('\n');
  }
  wake();
}

bool LineServer::offer(Client to, std::string_view line) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = connections_.find(to);
    if (found == connections_.end()) return false;
    Connection& c = found->second;
    if (c.out.size() + line.size() > kMostUnsent) return false;
    c.out.append(line).push_back('\n');
  }
  wake();
  return true;
}

void LineServer::part_from(Client client) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = connections_.find(client);
    if (found == connections_.end()) return;
    part(found->second);
  }
  wake();
}

void LineServer::part(Connection& c) {
  if (std::exchange(c.parting, true)) return;
  c.until = Clock::now() + kParting;
}

// Whether another line may be passed to the owner: unfetched answers must not grow.
bool LineServer::has_room(const Connection& c) {
  return c.unanswered < kMostUnanswered && c.out.size() < kMostUnsent;
}

// Whether a connection is over: its client is gone, or has all answers that it can get.
bool LineServer::done(const Connection& c) {
  if (c.file < 0) return true;
  const bool sent = c.out.empty();
  if (c.parting) return sent || Clock::now() >= c.until;
  return c.ended && sent && c.unanswered == 0;
}

void LineServer::let_go(Connections::iterator which) {
  if (which->second.file >= 0) close(which->second.file);
  events_.push_back({which->first, std::nullopt});
  happened_.notify_one();
  connections_.erase(which);
}

void LineServer::live() {
  std::vector<pollfd> files;
  std::vector<Client> ids;
  for (bool crowded = false;; crowded = false) {
    files.assign({{wake_, POLLIN, 0}, {socket_.file(), POLLIN, 0}});
    ids.clear();
    int longest = -1;  // no timeout [ms]
    {
      const std::lock_guard lock(mutex_);
      if (quit_) return;
      if (events_.size() > kMostEvents) files[1].fd = -1;
      for (const auto& [id, c] : connections_) {
        // A client without room is heard as well: it may ask to cut the force.
        const bool listens = !c.parting && !c.ended && !c.too_long;
        const int wanted = (listens ? POLLIN : 0) | (c.out.empty() ? 0 : POLLOUT);
        // A client that has ended would be reported all the time.
        files.push_back({c.ended && wanted == 0 ? -1 : c.file, static_cast<short>(wanted), 0});
        ids.push_back(id);
        if (c.parting) longest = static_cast<int>(kParting.count()) / 10;
      }
    }
    poll(files.data(), files.size(), longest);
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t woken = ::read(wake_, &count, sizeof(count));
    {
      const std::lock_guard lock(mutex_);
      for (std::size_t i = 0; i < ids.size(); ++i) {
        const auto found = connections_.find(ids[i]);
        if (found == connections_.end()) continue;
        serve(found->second, ids[i], files[i + 2].revents);
        crowded = crowded || found->second.looked > 0;
        if (done(found->second)) let_go(found);
      }
      if ((files[1].revents & POLLIN) != 0) greet();
    }
    if (crowded) std::this_thread::sleep_for(kBreath);
  }
}

void LineServer::greet() {
  const int file = accept4(socket_.file(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (file < 0) return;
  if (connections_.size() < kMostClients) {
    connections_[next_++].file = file;
    return;
  }
  const std::string line = fmt::format(
      "{{\"id\":null,\"error\":\"{} programs are connected already; no more can connect\"}}\n",
      kMostClients);
  [[maybe_unused]] const ssize_t sent = send(file, line.data(), line.size(), MSG_NOSIGNAL);
  close(file);
}

void LineServer::serve(Connection& c, Client id, short happened) {
  // The input of a client that has hung up is read to its end: its last line may matter.
  const bool gone = (happened & (POLLHUP | POLLERR | POLLNVAL)) != 0;
  if ((happened & POLLIN) != 0) read(c);
  split(c, id);
  while (gone && read(c)) split(c, id);
  write(c);
  if (!gone || c.file < 0) return;
  close(c.file);
  c.file = -1;
}

// Returns false if there was nothing to read.
bool LineServer::read(Connection& c) {
  if (c.file < 0 || c.parting || c.ended || c.too_long) return false;
  std::array<char, kPiece> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled next
  const ssize_t size = recv(c.file, bytes.data(), bytes.size(), 0);
  if (size > 0) {
    c.in.append(bytes.data(), static_cast<std::size_t>(size));
    look(c);
  } else if (size == 0) {
    c.ended = true;
  } else if (errno != EAGAIN && errno != EINTR) {
    close(c.file);
    c.file = -1;
  }
  return size > 0;
}

// Passes whole lines that have just arrived to at_once_, and drops those without room.
void LineServer::look(Connection& c) {
  while (true) {
    const std::size_t end = std::min(c.in.find('\n', c.looked), c.in.size());
    if (end - c.looked > kLongestLine) {
      c.in.resize(c.looked);
      c.too_long = true;
    }
    if (c.too_long || end == c.in.size()) return;
    const std::string_view line = std::string_view(c.in).substr(c.looked, end - c.looked);
    const bool counts = says_something(line);
    if (counts && at_once_) at_once_(line);
    if (counts && end < kMostWaiting) {
      c.looked = end + 1;
      continue;
    }
    if (counts) ++c.dropped;
    c.in.erase(c.looked, end + 1 - c.looked);
  }
}

void LineServer::split(Connection& c, Client id) {
  if (c.parting) return;
  std::size_t begin = 0;
  while (begin < c.looked && has_room(c)) {
    const std::size_t end = c.in.find('\n', begin);
    ++c.unanswered;
    events_.push_back({id, c.in.substr(begin, end - begin)});
    begin = end + 1;
    happened_.notify_one();
  }
  c.in.erase(0, begin);
  c.looked -= begin;
  if (c.looked > 0) return;
  if (c.dropped > 0 && has_room(c)) {
    c.out += fmt::format(
        "{{\"id\":null,\"error\":\"{} lines were dropped: at most {} bytes of lines may wait while "
        "the client does not read answers\"}}\n",
        std::exchange(c.dropped, 0), kMostWaiting);
  }
  if (!c.too_long) return;
  c.out += fmt::format(
      "{{\"id\":null,\"error\":\"a line has at most {} bytes; this line is longer\"}}\n",
      kLongestLine);
  part(c);
}

void LineServer::write(Connection& c) {
  if (c.file < 0 || c.out.empty()) return;
  const ssize_t sent = send(c.file, c.out.data(), c.out.size(), MSG_NOSIGNAL);
  if (sent > 0) {
    c.out.erase(0, static_cast<std::size_t>(sent));
  } else if (errno != EAGAIN && errno != EINTR) {
    close(c.file);
    c.file = -1;
  }
}

}  // namespace limpid
