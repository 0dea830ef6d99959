// Window led by programs on the control socket: it carries out their requests as menus and keys do.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "app/desktop/shell/desktop.h"
#include "app/desktop/shell/window.h"
#include "app/remote/remote.h"

namespace limpid {

class WindowRemote {
 public:
  // Listens at `socket`. Errors: ListenError.
  WindowRemote(const std::filesystem::path& socket, Desktop& desktop);
  ~WindowRemote() { d_.live.on_row = nullptr; }
  WindowRemote(const WindowRemote&) = delete;
  WindowRemote& operator=(const WindowRemote&) = delete;

  // Carries out requests; to be called once a turn of the window. Returns whether there were any.
  bool turn();
  // Takes the pictures that the window has written, or could not write.
  void saved(std::span<const SavedPicture> pictures);

 private:
  RemoteHost host();
  void add_actions(RemoteHost& host);
  void set(const Parameters& p, std::size_t lane);
  Answer open(const Keys& keys, LineServer::Client client);
  Answer open_scene(const std::filesystem::path& file);
  Answer open_arm(const std::filesystem::path& file, const std::string& tip);
  Answer play(const std::filesystem::path& file);
  Answer record(const Keys& keys);
  Answer stop();
  Answer start_over();
  Answer mark(const Keys& keys);
  Answer twin(const Keys& keys, LineServer::Client client);
  Answer blind(const Keys& keys, LineServer::Client client);
  Answer ask(const Keys& keys, LineServer::Client client);
  Answer picture(const Keys& keys);
  nlohmann::json place() const;
  void run(const char* command);
  std::string last_complaint(const char* otherwise) const;
  void follow_limits();
  void lead(LineServer::Client client);
  void follow_lead();
  void gone(LineServer::Client client);

  Desktop& d_;
  Parameters highest_;  // settings with the limits that the user chose
  std::string limits_;  // as last seen, or set from here
  const Stage* stage_ = nullptr;
  std::uint64_t tick_ = 0;                   // of the newest row
  std::optional<LineServer::Client> hides_;  // client that hides the settings
  std::optional<LineServer::Client> asks_;   // client whose question is open
  std::set<LineServer::Client> leaders_;     // clients that have changed settings or scene
  bool study_ = false;                       // a leader has hidden the settings
  std::filesystem::path recorded_;           // by a client
  bool records_ = false;                     // a client's recording that nobody has stopped
  std::vector<SavedPicture> saved_;          // that a client waits for
  Remote remote_;                            // last member: is destroyed first
};

}  // namespace limpid
