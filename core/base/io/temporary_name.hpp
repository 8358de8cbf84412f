// The names under which files and folders are written before they get their own, and how a living process
// marks them as in use.
#pragma once

#include <sys/types.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace fusebench::io {

/// ".<name>.<process>[-<attempt>].tmp" beside a path; the dot keeps it out of listings. Processes of other
/// machines can have the same number, so it may be taken: the next attempt has another one.
[[nodiscard]] std::filesystem::path hidden_sibling(const std::filesystem::path& path, int attempt,
                                                   pid_t process = getpid());

/// The <name> of what hidden_sibling() gives; nothing for any other name.
[[nodiscard]] std::optional<std::string> name_of_hidden_sibling(std::string_view name);

/// How many names are tried. Concurrent access is rare and short, so a few are enough.
constexpr int kNameAttempts = 100;

/// Marks a folder or a plain file as in use; the operating system releases the lock when the process ends for
/// any reason. A link is not followed. -1 and errno where the file system has no locks, or, with EWOULDBLOCK,
/// where another process holds this one.
[[nodiscard]] int lock_place(const std::filesystem::path& place);

/// Whether a file, or a folder and all that is in it, was last written longer ago than that.
[[nodiscard]] bool is_unchanged_for(const std::filesystem::path& place, std::chrono::hours age);

}  // namespace fusebench::io
