#include "eval/suites/engine/invocation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/base/io/bounded_text.hpp"
#include "core/base/io/fingerprint.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/suites/engine/run_claim.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/text_file.hpp"

namespace fusebench::engine {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Result<std::string> text_of(const fs::path& file) {
  return io::whole_text(file, std::uintmax_t{1} << 26, "invocation");
}

/// Not again if it is there; but a power cut leaves zeros, or nothing in a file.
Result<void> keep_text(const fs::path& file, const std::string& text) {
  const auto there = text_of(file);
  if (there && *there == text) return {};
  return text::write_text_file(file, text);
}

/// The library's own conversion to int wraps.
Result<int> number_in(const Json& json, const char* key, int least, int most, const fs::path& file) {
  const Json& value = json.at(key);
  if (value.is_number_integer() && value.get<double>() >= least && value.get<double>() <= most)
    return value.get<int>();
  return fail(ErrorCode::data_corrupt,
              fmt::format("{}: {} = {} (allowed: an integer, {} .. {})", file.string(), key,
                          text::json_text(value, -1), least, most));
}

std::string absolute_text(const fs::path& path) {
  std::error_code ignored;
  return path.empty() ? "" : fs::absolute(path, ignored).lexically_normal().string();
}

}  // namespace

fs::path invocations_folder(const fs::path& out) { return engine_folder(out) / "invocations"; }

Result<suites::Suite> suite_of(const Invocation& invocation) {
  auto suite = suites::read_suite(invocation.suite);
  if (!suite) return suite;
  const SuiteOverrides& overrides = invocation.overrides;
  if (overrides.repetitions > 0) suite->repetitions = overrides.repetitions;
  if (overrides.replicates > 0) suite->replicates = overrides.replicates;
  for (const run::KeptFiles kept : {run::KeptFiles::all, run::KeptFiles::small}) {
    if (overrides.kept == run::to_string(kept)) suite->kept = kept;
  }
  return suite;
}

Result<fs::path> keep(const Invocation& invocation) {
  const auto suite = text_of(invocation.suite);
  if (!suite) return tl::unexpected(suite.error());
  const BatchOptions& options = invocation.options;
  std::error_code ignored;
  const Json json = {{"working_folder", fs::current_path(ignored).string()},
                     {"data", absolute_text(options.data)},
                     {"simulated", absolute_text(options.simulated)},
                     {"threads", options.threads},
                     {"profile", options.profile},
                     {"sets", options.sets},
                     {"only", options.only},
                     {"repetitions", invocation.overrides.repetitions},
                     {"replicates", invocation.overrides.replicates},
                     {"keep", invocation.overrides.kept}};
  const std::string text = text::json_text(json) + "\n";
  io::Fingerprint identity;
  identity.add(*suite);
  identity.add(text);
  const std::string name = identity.hex().substr(0, 8);
  const fs::path folder = invocations_folder(options.out);
  fs::path file = folder / (name + ".json");
  if (auto kept = keep_text(folder / (name + ".toml"), *suite); !kept) return tl::unexpected(kept.error());
  if (auto kept = keep_text(file, text); !kept) return tl::unexpected(kept.error());
  return file;
}

Result<Invocation> read_invocation(const fs::path& file) {
  const auto text = text_of(file);
  if (!text) return tl::unexpected(text.error());
  try {
    const Json json = Json::parse(*text);
    Invocation invocation;
    invocation.suite = fs::path(file).replace_extension(".toml");
    invocation.options.data = json.at("data").get<std::string>();
    // <out>/.fusebench/invocations/<name>.json; the folder may have been moved.
    invocation.options.out = file.parent_path().parent_path().parent_path();
    invocation.options.simulated = json.at("simulated").get<std::string>();
    const auto threads = number_in(json, "threads", 1, run::kMostThreads, file);
    if (!threads) return tl::unexpected(threads.error());
    const auto repetitions = number_in(json, "repetitions", 0, run::kMostRepetitions, file);
    if (!repetitions) return tl::unexpected(repetitions.error());
    const auto replicates = json.contains("replicates")
                                ? number_in(json, "replicates", 0, run::kMostReplicates, file)
                                : Result<int>(0);
    if (!replicates) return tl::unexpected(replicates.error());
    invocation.options.threads = *threads;
    invocation.options.profile = json.value("profile", false);  // older ones have none
    invocation.options.sets = json.at("sets").get<std::vector<std::string>>();
    invocation.options.only = json.at("only").get<std::vector<std::string>>();
    invocation.overrides = {*repetitions, *replicates, json.at("keep")};
    invocation.working_folder = json.at("working_folder").get<std::string>();
    return invocation;
  } catch (const Json::exception& error) {
    return fail(ErrorCode::data_corrupt, fmt::format("{}: {}", file.string(), error.what()));
  }
}

std::size_t copy_invocations(const fs::path& from, const fs::path& into) {
  const auto files = kept_invocations(from);
  if (!files) return 0;  // none
  std::size_t left_out = 0;
  for (const fs::path& file : *files) {
    const fs::path suite_file = fs::path(file).replace_extension(".toml");
    const auto text = text_of(file);
    const auto suite = text_of(suite_file);
    if (!text || !suite || !read_invocation(file)) {
      ++left_out;
      continue;
    }
    const fs::path folder = invocations_folder(into);
    static_cast<void>(keep_text(folder / suite_file.filename(), *suite));
    static_cast<void>(keep_text(folder / file.filename(), *text));
  }
  return left_out;
}

Result<std::vector<fs::path>> kept_invocations(const fs::path& out) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(invocations_folder(out), error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() == ".json") files.push_back(entry->path());
  }
  std::ranges::sort(files);
  if (!files.empty()) return files;
  return fail(ErrorCode::data_missing, fmt::format("{}: no suite was run into this folder", out.string()),
              "`fusebench bench SUITE --out DIR` writes one");
}

}  // namespace fusebench::engine
