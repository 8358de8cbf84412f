#include "eval/suites/engine/slurm_commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>
#include <sstream>
#include <string_view>
#include <thread>

#include "eval/record/process/child_processes.hpp"

namespace fusebench::engine {

namespace {

constexpr int kNotFound = 127;  // of env

/// "a|b|c" by lines.
std::vector<std::vector<std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, '|');) fields.push_back(field);
    if (!fields.empty()) rows.push_back(std::move(fields));
  }
  return rows;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

tl::unexpected<Error> no_sbatch() {
  return fail(ErrorCode::usage, "there is no sbatch here: --executor slurm is for hosts that submit to Slurm",
              "Debian: apt install slurm-client; without Slurm, -j runs on this machine");
}

tl::unexpected<Error> no_controller(std::string_view command, const std::string& why) {
  return fail(ErrorCode::run_failed, fmt::format("no Slurm controller answers ({}: {})", command, why),
              "is slurmctld running, and does SLURM_CONF or /etc/slurm/slurm.conf name it? `sinfo` shows");
}

}  // namespace

SlurmQueue::Answer SlurmQueue::ask(const std::vector<std::string>& command) const {
  using Clock = std::chrono::steady_clock;
  std::vector<std::string> words = {"/usr/bin/env"};
  words.insert(words.end(), command.begin(), command.end());
  auto child = process::ChildProcess::start(words);
  if (!child) return {};
  const auto until = Clock::now() + std::chrono::duration<double>(limit_s_);
  while (Clock::now() < until) {
    if (const auto end = child->poll()) {
      const int code = end->exit_code.value_or(-1);
      return {code == 0, code != kNotFound, code, end->output, end->errors};
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return {};
}

Result<void> SlurmQueue::check() const {
  if (!ask({"sbatch", "--version"}).found) return no_sbatch();
  const Answer answer = ask({"sinfo", "-h", "-o", "%P"});
  if (answer.came || !answer.found) return {};  // without sinfo, sbatch will say it
  return no_controller("sinfo", answer.errors.empty() ? "no answer" : first_line(answer.errors));
}

Result<std::string> SlurmQueue::submit(const SlurmArray& array) const {
  std::vector<std::string> command = {"sbatch",
                                      "--parsable",
                                      "--no-requeue",
                                      "--job-name=" + array.name,
                                      fmt::format("--array=0-{}", array.tasks - 1),
                                      fmt::format("--cpus-per-task={}", array.cpus),
                                      "--output=" + (array.logs / "%A_%a.txt").string()};
  if (array.time_s > 0) command.push_back(fmt::format("--time={:.0f}", std::ceil(array.time_s / 60)));
  if (!array.excluded.empty()) command.push_back(fmt::format("--exclude={}", fmt::join(array.excluded, ",")));
  command.insert(command.end(), array.arguments.begin(), array.arguments.end());
  command.push_back(array.script.string());
  const Answer answer = ask(command);
  if (answer.came) {
    const std::string job = first_line(answer.output);
    return job.substr(0, job.find(';'));
  }
  if (!answer.found) return no_sbatch();
  const std::string why = answer.errors.empty() ? "no answer" : first_line(answer.errors);
  // What waits for a controller may succeed later; what it refuses will not.
  const bool silent = answer.errors.empty() || why.find("contact") != std::string::npos ||
                      why.find("imed out") != std::string::npos || why.find("onnect") != std::string::npos ||
                      why.find("resolve_ctls") != std::string::npos;
  if (silent) return no_controller("sbatch", why);
  return fail(ErrorCode::usage, fmt::format("sbatch: {}", why),
              "--slurm-arg passes arguments (partition, account) to sbatch");
}

std::optional<std::map<std::string, SlurmTask>> SlurmQueue::tasks(const std::string& name) const {
  const Answer answer = ask({"squeue", "-h", "-r", "--name=" + name, "-o", "%i|%T|%N"});
  if (!answer.came) return std::nullopt;
  std::map<std::string, SlurmTask> tasks;
  for (const auto& row : rows_of(answer.output)) {
    if (row.size() < 2) continue;
    tasks[row[0]] = {row[1], row.size() > 2 ? row[2] : ""};
  }
  return tasks;
}

std::optional<std::map<std::string, std::string>> SlurmQueue::nodes() const {
  const Answer answer = ask({"sinfo", "-h", "-N", "-o", "%N|%T"});
  if (!answer.came) return std::nullopt;
  std::map<std::string, std::string> nodes;
  for (const auto& row : rows_of(answer.output)) {
    if (row.size() == 2) nodes[row[0]] = row[1];
  }
  return nodes;
}

void SlurmQueue::cancel(const std::vector<std::string>& tasks) const {
  if (tasks.empty()) return;
  std::vector<std::string> command = {"scancel"};
  command.insert(command.end(), tasks.begin(), tasks.end());
  static_cast<void>(ask(command));
}

void SlurmQueue::cancel_all(const std::string& name) const {
  static_cast<void>(ask({"scancel", "--name=" + name}));
}

}  // namespace fusebench::engine
