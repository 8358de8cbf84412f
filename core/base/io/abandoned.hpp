// What processes that were killed left under temporary names (StagedFolder, write_file_atomically()).
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <system_error>
#include <vector>

namespace fusebench::io {

struct Abandoned {
  struct Kept {
    std::filesystem::path path;
    std::error_code reason;
  };
  std::vector<std::filesystem::path> removed;  ///< and is gone; if it shall only look, what would be
  std::vector<Kept> kept;                      ///< what could not be removed, or not all of it
};

/// Removes the abandoned temporary folders and files in `parent`. A living process holds a lock of each, so a
/// folder whose lock nobody holds is abandoned, and a file if it also has not changed for an hour: it is
/// written at once, and a machine that shares the folder but not the locks may be writing it. Where a file
/// system has no locks (folders over NFS), what has not changed for a day.
Abandoned remove_abandoned(const std::filesystem::path& parent, bool only_look = false);

/// Of one place that is about to be written again, those that have not changed for an hour (files) or for a
/// day (folders: a run of another machine may write nothing for hours).
void remove_abandoned_of(const std::filesystem::path& place);

/// Of one place, what a process of this machine that has ended left: of any age, where there are locks.
void remove_abandoned_of(const std::filesystem::path& place, pid_t ended_process);

}  // namespace fusebench::io
