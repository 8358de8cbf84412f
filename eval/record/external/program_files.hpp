// The files that an external program consists of, as far as its command names them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fusebench::external {

/// The file of a program, as the system finds it; empty if there is none.
[[nodiscard]] std::filesystem::path file_of_program(const std::string& name);

/// A text with the folder in the place of {folder}.
[[nodiscard]] std::string with_folder(std::string argument, const std::filesystem::path& folder);

/// Without repetition, in this order: files by absolute paths among the arguments of a command and their
/// words (also by {folder} and by variables of the environment); the program; programs in PATH and files that
/// words of `sh -c` texts and of scripts name; shared libraries of all of these (ldd). Programs and libraries
/// of the operating system (/usr/bin, /usr/lib, ...) are left out, but for the command's own program. Folders
/// are not searched.
[[nodiscard]] std::vector<std::filesystem::path> files_of_command(const std::vector<std::string>& command,
                                                                  const std::filesystem::path& folder);

}  // namespace fusebench::external
