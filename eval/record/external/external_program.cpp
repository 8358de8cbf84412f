#include "eval/record/external/external_program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <utility>

#include "core/base/io/fingerprint.hpp"
#include "core/base/io/input_file.hpp"
#include "core/base/nearest_name.hpp"
#include "core/config/toml_document.hpp"
#include "eval/record/external/program_files.hpp"
#include "eval/record/external/system_name.hpp"

namespace fusebench::external {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 17> kKeys = {"name",
                                                    "sentence",
                                                    "export",
                                                    "command",
                                                    "version",
                                                    "imu",
                                                    "deterministic",
                                                    "repetitions",
                                                    "limits.time_s",
                                                    "limits.memory_mb",
                                                    "trajectory.file",
                                                    "trajectory.format",
                                                    "trajectory.unit",
                                                    "trajectory.pose",
                                                    "trajectory.online",
                                                    "mesh.file",
                                                    "mesh.unit"};
constexpr std::array<std::string_view, 6> kPlaceholders = {"recording", "calibration", "output",
                                                           "threads",   "seed",        "folder"};
constexpr int kFewestRepetitions = 5;  // of what is not deterministic

Result<std::string> text_of(const config::TomlEntry& entry) {
  const auto* text = config::plain_value<std::string>(entry);
  if (text == nullptr || text->empty()) return config::wrong_value(entry, "a text in quotes");
  return *text;
}

template <class Value>
Result<Value> one_of(const config::TomlEntry& entry,
                     std::initializer_list<std::pair<std::string_view, Value>> choices) {
  const auto text = text_of(entry);
  std::vector<std::string_view> names;
  for (const auto& [name, value] : choices) {
    if (text && *text == name) return value;
    names.push_back(name);
  }
  return config::wrong_value(entry, fmt::format("{}", fmt::join(names, " or ")));
}

Result<bool> flag_of(const config::TomlEntry& entry) {
  const auto* flag = config::plain_value<bool>(entry);
  if (flag == nullptr) return config::wrong_value(entry, "true or false");
  return *flag;
}

Result<double> positive_number(const config::TomlEntry& entry) {
  const auto* number = config::plain_value<double>(entry);
  const auto* integer = config::plain_value<std::int64_t>(entry);
  const double value = number != nullptr ? *number : integer != nullptr ? static_cast<double>(*integer) : 0;
  if (!(value > 0)) return config::wrong_value(entry, "a number above 0");
  return value;
}

Result<void> check_placeholders(const config::TomlEntry& entry, std::string_view argument) {
  for (std::size_t begin = argument.find('{'); begin != std::string_view::npos;
       begin = argument.find('{', begin + 1)) {
    const std::size_t end = argument.find('}', begin);
    if (end == std::string_view::npos)
      return fail(ErrorCode::configuration,
                  fmt::format("{}: {}: '{}' has no '}}'", entry.place, entry.key, argument.substr(begin)));
    const std::string_view name = argument.substr(begin + 1, end - begin - 1);
    if (std::ranges::find(kPlaceholders, name) != kPlaceholders.end()) continue;
    return fail(ErrorCode::configuration,
                fmt::format("{}: {}: there is no placeholder {{{}}}", entry.place, entry.key, name),
                fmt::format("there are {{{}}}", fmt::join(kPlaceholders, "}, {")));
  }
  return {};
}

Result<std::vector<std::string>> command_of(const config::TomlEntry& entry) {
  const auto* list = std::get_if<config::TomlList>(&entry.value);
  std::vector<std::string> command;
  for (const config::OptionValue& value : list == nullptr ? config::TomlList{} : *list) {
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr) return config::wrong_value(entry, "a list of texts: the program and its arguments");
    if (auto known = check_placeholders(entry, *text); !known) return tl::unexpected(known.error());
    command.push_back(*text);
  }
  if (command.empty()) return config::wrong_value(entry, "a list of texts: the program and its arguments");
  return command;
}

/// Below {output}, and not outside of it.
Result<std::string> output_file(const config::TomlEntry& entry) {
  auto text = text_of(entry);
  if (!text) return text;
  const fs::path path = fs::path(*text).lexically_normal();
  if (path.is_absolute() || (!path.empty() && *path.begin() == ".."))
    return config::wrong_value(entry, "a path below {output}");
  return text;
}

template <class Target>
Result<void> store(Result<Target> value, Target& target) {
  if (!value) return tl::unexpected(value.error());
  target = std::move(*value);
  return {};
}

Result<void> read_trajectory_entry(const config::TomlEntry& entry, std::string_view key,
                                   SystemTrajectory& trajectory) {
  if (key == "file") {
    auto file = output_file(entry);
    if (!file) return tl::unexpected(file.error());
    trajectory.file = std::move(*file);
    return {};
  }
  if (key == "unit") return store(one_of<double>(entry, {{"m", 1.0}, {"mm", 1e-3}}), trajectory.unit_m);
  if (key == "pose")
    return store(one_of<bool>(entry, {{"camera_to_world", false}, {"world_to_camera", true}}),
                 trajectory.world_to_camera);
  if (key == "online") return store(flag_of(entry), trajectory.online);
  const auto name = text_of(entry);
  if (!name) return tl::unexpected(name.error());
  const auto format = trajectory_files::parse_trajectory_format(*name);
  if (!format) return config::wrong_value(entry, "a format of trajectories: " + format.error().hint);
  trajectory.format = *format;
  return {};
}

Result<void> read_name(const config::TomlEntry& entry, ExternalProgram& program) {
  auto name = text_of(entry);
  if (!name) return tl::unexpected(name.error());
  switch (fault_of_system_name(*name)) {
    case NameFault::characters:
      return config::wrong_value(entry, "letters, digits, '-', '_', '+' and '.'");
    case NameFault::is_variant:
      return config::wrong_value(entry, fmt::format("no variant of this program ({} is one)", *name));
    case NameFault::none:
      break;
  }
  program.name = std::move(*name);
  return {};
}

Result<void> read_input(const config::TomlEntry& entry, ExternalProgram& program) {
  const auto name = text_of(entry);
  if (!name) return tl::unexpected(name.error());
  if (*name == "none") return {};
  const auto format = exports::parse_export_format(*name);
  if (!format)
    return config::wrong_value(entry,
                               fmt::format("none, {}", fmt::join(exports::export_format_names(), ", ")));
  program.input = *format;
  return {};
}

Result<void> read_repetitions(const config::TomlEntry& entry, ExternalProgram& program) {
  const auto* count = config::plain_value<std::int64_t>(entry);
  constexpr std::int64_t kMost = 1000;
  if (count == nullptr || *count < 1 || *count > kMost)
    return config::wrong_value(entry, fmt::format("an integer in 1 .. {}", kMost));
  program.repetitions = static_cast<int>(*count);
  return {};
}

Result<void> read_limit(const config::TomlEntry& entry, ExternalProgram& program) {
  const auto number = positive_number(entry);
  if (!number) return tl::unexpected(number.error());
  if (entry.key == "limits.time_s") {
    program.limits.time_s = *number;
  } else {
    program.limits.memory_bytes = static_cast<std::uint64_t>(*number * 1e6);
  }
  return {};
}

Result<void> read_entry(const config::TomlEntry& entry, ExternalProgram& program) {
  constexpr std::string_view kTrajectory = "trajectory.";
  const std::string& key = entry.key;
  if (std::ranges::find(kKeys, key) == kKeys.end()) {
    return fail(ErrorCode::configuration,
                fmt::format("{}: unknown key '{}'{}", entry.place, key, nearest_hint(key, kKeys)),
                fmt::format("a system has {}", fmt::join(kKeys, ", ")));
  }
  if (key == "name") return read_name(entry, program);
  if (key == "sentence") return store(text_of(entry), program.sentence);
  if (key == "export") return read_input(entry, program);
  if (key == "command") return store(command_of(entry), program.command);
  if (key == "version") return store(command_of(entry), program.version_command);
  if (key == "imu")
    return store(one_of<std::string>(entry, {{"none", "none"}, {"recorded", "recorded"}}), program.imu);
  if (key == "deterministic") return store(flag_of(entry), program.deterministic);
  if (key == "repetitions") return read_repetitions(entry, program);
  if (key.starts_with("limits.")) return read_limit(entry, program);
  if (key == "mesh.file") return store(output_file(entry), program.mesh.file);
  if (key == "mesh.unit")
    return store(one_of<double>(entry, {{"m", 1.0}, {"mm", 1e-3}}), program.mesh.unit_m);
  return read_trajectory_entry(entry, std::string_view(key).substr(kTrajectory.size()), program.trajectory);
}

/// Its first line; or why the program cannot run here.
void ask_version(ExternalProgram& program) {
  const std::vector<std::string>& command = program.version_command;
  if (command.empty() || !program.absent.empty()) return;
  constexpr double kPatience_s = 60;
  std::vector<std::string> asked;
  for (const std::string& argument : command) asked.push_back(with_folder(argument, program.folder()));
  const auto end = process::run_program(asked, program.folder(), {kPatience_s, 0}, [] { return true; });
  if (!end) {
    program.absent = end.error().message;
  } else if (!end->succeeded) {
    const std::string said = end->output.substr(0, end->output.find_last_not_of('\n') + 1);
    program.absent = fmt::format("its version cannot be read: {} ({})", fmt::join(asked, " "),
                                 said.empty() ? end->how : said.substr(said.rfind('\n') + 1));
  } else {
    program.version = end->output.substr(0, end->output.find('\n'));
  }
}

Result<void> identify(ExternalProgram& program) {
  io::Fingerprint identity;
  if (auto added = identity.add_file(program.file); !added) return tl::unexpected(added.error());
  if (file_of_program(program.command.front()).empty()) {
    program.absent = fmt::format("the program {} is not installed", program.command.front());
    return {};
  }
  for (const fs::path& named : files_of_command(program.command, program.folder())) {
    if (auto added = identity.add_file(named); !added) return tl::unexpected(added.error());
  }
  identity.add(program.version);
  program.identity = identity.hex();
  return {};
}

}  // namespace

Result<ExternalProgram> read_external_program(const fs::path& file) {
  const auto document = config::read_toml(file);
  if (!document) return tl::unexpected(document.error());
  ExternalProgram program;
  bool counted = false;
  for (const config::TomlEntry& entry : document->entries) {
    if (auto read = read_entry(entry, program); !read) return tl::unexpected(read.error());
    counted |= entry.key == "repetitions";
  }
  const std::array<std::pair<std::string_view, bool>, 3> required = {
      {{"name", !program.name.empty()},
       {"command", !program.command.empty()},
       {"trajectory.file", !program.trajectory.file.empty()}}};
  for (const auto& [key, there] : required) {
    if (!there)
      return fail(ErrorCode::configuration, fmt::format("{}: a system needs {}", file.string(), key));
  }
  if (!program.deterministic && !counted) program.repetitions = kFewestRepetitions;
  if (!program.deterministic && program.repetitions < kFewestRepetitions) {
    return fail(
        ErrorCode::configuration,
        fmt::format("{}: repetitions = {} of a program that is not deterministic", file.string(),
                    program.repetitions),
        fmt::format("at least {}, so that tables have a range; or deterministic = true", kFewestRepetitions));
  }
  std::error_code ignored;
  program.file = fs::absolute(file, ignored);
  std::ifstream stream = io::input_file(file);
  program.definition.assign(std::istreambuf_iterator<char>(stream), {});
  return program;
}

Result<void> find_installed(ExternalProgram& program) {
  ask_version(program);
  return identify(program);
}

}  // namespace fusebench::external
