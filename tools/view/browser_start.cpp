#include "tools/view/browser_start.h"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace planetree::tools {
namespace {

bool has_desktop() {
  for (const char* name : {"WAYLAND_DISPLAY", "DISPLAY"})
    if (const char* const value = std::getenv(name); value && *value != '\0') return true;
  return false;
}

}  // namespace

void start_browser(const std::string& page) {
  if (!has_desktop()) return;
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  if (::posix_spawn_file_actions_init(&files) != 0) return;
  if (::posix_spawnattr_init(&attributes) == 0) {
    // It is noisy, and a key that ends the session must not end the browser.
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      ::posix_spawn_file_actions_addopen(&files, stream, "/dev/null", O_RDWR, 0);
    sigset_t none;
    ::sigemptyset(&none);
    ::posix_spawnattr_setsigmask(&attributes, &none);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSID);
    std::string program = "xdg-open", argument = page;
    char* const arguments[] = {program.data(), argument.data(), nullptr};
    pid_t process = 0;
    ::posix_spawnp(&process, program.c_str(), &files, &attributes, arguments, environ);
    ::posix_spawnattr_destroy(&attributes);
  }
  ::posix_spawn_file_actions_destroy(&files);
}

}  // namespace planetree::tools
