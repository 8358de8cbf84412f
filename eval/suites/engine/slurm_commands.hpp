// The commands of Slurm, each with a time limit: a dead controller would hold them for minutes. An answer
// that does not come says nothing about the queue, least of all that it is empty.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::engine {

/// One array to submit.
struct SlurmArray {
  std::string name;  ///< of the job
  std::filesystem::path script;
  std::filesystem::path logs;          ///< folder of what tasks print
  std::size_t tasks = 0;               ///< numbers 0 to tasks - 1
  int cpus = 1;                        ///< of each task
  double time_s = 0;                   ///< of each task; 0: the partition's
  std::vector<std::string> excluded;   ///< nodes
  std::vector<std::string> arguments;  ///< further ones of sbatch
};

struct SlurmTask {
  std::string state;  ///< "PENDING", "RUNNING", ...
  std::string node;   ///< empty while it waits
};

class SlurmQueue {
 public:
  explicit SlurmQueue(double command_limit_s) : limit_s_(command_limit_s) {}

  /// Whether arrays can be submitted from here. Errors: usage if there is no sbatch; run_failed if no
  /// controller answers.
  [[nodiscard]] Result<void> check() const;
  /// The job's number. Errors: usage if there is no sbatch, or it refuses the array; run_failed if nobody
  /// answered: the array may have been taken all the same.
  [[nodiscard]] Result<std::string> submit(const SlurmArray& array) const;
  /// Tasks of all jobs of that name, by "job_task"; nothing if nobody answered.
  [[nodiscard]] std::optional<std::map<std::string, SlurmTask>> tasks(const std::string& name) const;
  /// States of nodes by name ("idle", "down*"); nothing if nobody answered.
  [[nodiscard]] std::optional<std::map<std::string, std::string>> nodes() const;
  void cancel(
      const std::vector<std::string>& tasks) const;  ///< by "job_task"; whether it worked shows in tasks()
  void cancel_all(const std::string& name) const;

 private:
  struct Answer {
    bool came = false;
    bool found = true;  ///< the program
    int exit_code = 0;
    std::string output;
    std::string errors;
  };
  [[nodiscard]] Answer ask(const std::vector<std::string>& command) const;

  double limit_s_;
};

}  // namespace fusebench::engine
