// Accepts the arguments of evo_ape, evo_rpe, evo_traj and evo_res after `fusebench eval ape`, `rpe`, `traj`
// and `res`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::cli::trajectories {

/// The arguments of fusebench, without its name. `ape` is `ate`. Some options take a value here
/// that evo's flags do not have; without a value they are evo's flag: --align is -a unless a mode follows,
/// --plot and -p draw into a file of the usual name unless the name of a picture follows. Arguments of other
/// verbs stay as they are.
///
/// Error usage: a bag (bag, bag2, mcap), a flag of evo's that has no counterpart here or one of TUM's
/// scripts, with what to do instead, or a word behind --align that is neither a mode nor a format nor a file.
[[nodiscard]] Result<std::vector<std::string>> with_own_spelling(std::vector<std::string> arguments);

/// What evo calls a verb of `eval`, if that is another name; else empty.
[[nodiscard]] std::string_view name_in_evo(std::string_view verb);

/// Removes a format before the files, as in `evo_ape tum ref.txt est.txt`, from the list. Error
/// usage: it is given twice.
[[nodiscard]] Result<void> take_leading_format(std::vector<std::string>& files, std::string& format);

}  // namespace fusebench::cli::trajectories
