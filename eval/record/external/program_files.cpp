#include "eval/record/external/program_files.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string_view>
#include <system_error>

#include "core/base/io/input_file.hpp"
#include "eval/record/process/program_run.hpp"

namespace fusebench::external {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostScriptBytes = 1U << 20;

bool is_below(const fs::path& file, std::span<const std::string_view> folders) {
  return std::ranges::any_of(folders,
                             [&](std::string_view folder) { return file.string().starts_with(folder); });
}

/// Programs that come with the operating system.
bool is_system_program(const fs::path& file) {
  constexpr std::array<std::string_view, 4> kFolders = {"/bin/", "/sbin/", "/usr/bin/", "/usr/sbin/"};
  return is_below(file, kFolders);
}

bool is_system_library(const fs::path& file) {
  constexpr std::array<std::string_view, 4> kFolders = {"/lib/", "/lib64/", "/usr/lib/", "/usr/lib64/"};
  return is_below(file, kFolders);
}

/// What a shell or an option such as --model=FILE may separate.
std::vector<std::string> words_of(std::string_view text) {
  constexpr std::string_view kBetween = " \t\r\n\"'`;|&()<>=,:";
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(kBetween), text.size());
    if (end > 0) words.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

/// $NAME and ${NAME} as their value.
std::string with_environment(const std::string& word) {
  if (!word.starts_with('$')) return word;
  std::string name = word.substr(1);
  if (name.starts_with('{') && name.ends_with('}')) name = name.substr(1, name.size() - 2);
  const char* const value = std::getenv(name.c_str());
  return value == nullptr ? word : value;
}

std::string first_bytes(const fs::path& file, std::size_t count) {
  std::string bytes(count, '\0');
  std::ifstream stream = io::input_file(file);
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

/// The text of a script; nothing of other files.
std::optional<std::string> script_text(const fs::path& file) {
  std::error_code error;
  if (fs::file_size(file, error) > kMostScriptBytes || error || first_bytes(file, 2) != "#!")
    return std::nullopt;
  std::ifstream stream = io::input_file(file);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

/// Paths in what ldd prints: "libx.so => /path/libx.so (0x...)".
std::vector<fs::path> libraries_of(const fs::path& file) {
  std::vector<fs::path> libraries;
  if (first_bytes(file, 4) !=
      "\x7f"
      "ELF")
    return libraries;
  constexpr double kPatience_s = 20;
  // Without those of the system: of a long output only the end is kept.
  const auto end = process::run_program(
      {"sh", "-c", "ldd \"$1\" | grep -v '=> /\\(usr/\\)\\?lib'; true", "sh", file.string()}, "/",
      {kPatience_s, 0}, [] { return true; });
  if (!end || !end->succeeded) return libraries;
  std::istringstream lines(end->output);
  for (std::string word; lines >> word;)
    if (word.starts_with('/')) libraries.emplace_back(word);
  return libraries;
}

class FileCollection {
 public:
  /// Nothing if the file does not exist or is there already.
  void add(const fs::path& file) {
    std::error_code error;
    if (file.empty() || !file.is_absolute() || !fs::is_regular_file(file, error)) return;
    const fs::path place = fs::canonical(file, error);
    if (!error && known_.insert(place).second) files_.push_back(file);
  }
  void add_named_by(const std::string& word) { add(with_environment(word)); }
  /// Of a shell's text, which names many of the operating system.
  void add_named_in_text(const std::string& word) {
    const fs::path file = with_environment(word);
    if (!is_system_program(file)) add(file);
  }
  /// A program that a word of a shell's text names.
  void add_program(const std::string& word) {
    if (word.find('/') != std::string::npos) return;
    const fs::path file = file_of_program(word);
    if (!is_system_program(file)) add(file);
  }
  [[nodiscard]] const std::vector<fs::path>& files() const { return files_; }

 private:
  std::vector<fs::path> files_;
  std::set<fs::path> known_;
};

}  // namespace

fs::path file_of_program(const std::string& name) {
  if (name.find('/') != std::string::npos)
    return access(name.c_str(), X_OK) == 0 ? fs::path(name) : fs::path();
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
  std::error_code error;
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path file = fs::path(folder) / name;
    if (access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file, error)) return file;
  }
  return {};
}

std::string with_folder(std::string argument, const fs::path& folder) {
  constexpr std::string_view kFolder = "{folder}";
  for (std::size_t at = argument.find(kFolder); at != std::string::npos;
       at = argument.find(kFolder, at + folder.string().size()))
    argument.replace(at, kFolder.size(), folder.string());
  return argument;
}

std::vector<fs::path> files_of_command(const std::vector<std::string>& command, const fs::path& folder) {
  FileCollection found;
  std::vector<std::string> texts;  // of shells
  for (std::size_t i = 0; i < command.size(); ++i) {
    const std::string argument = with_folder(command[i], folder);
    found.add_named_by(argument);
    for (const std::string& word : words_of(argument)) found.add_named_by(word);
    if (i > 0 && command[i - 1] == "-c") texts.push_back(argument);
  }
  const fs::path program = file_of_program(command.front());
  std::error_code ignored;
  if (!program.empty()) found.add(fs::absolute(program, ignored));
  const std::size_t named = found.files().size();
  for (std::size_t i = 0; i < named; ++i)
    if (auto script = script_text(found.files()[i])) texts.push_back(std::move(*script));
  for (const std::string& text : texts) {
    for (const std::string& word : words_of(text)) {
      found.add_named_in_text(word);
      found.add_program(word);
    }
  }
  const std::vector<fs::path> programs = found.files();
  for (const fs::path& file : programs)
    for (const fs::path& library : libraries_of(file))
      if (!is_system_library(library)) found.add(library);
  return found.files();
}

}  // namespace fusebench::external
