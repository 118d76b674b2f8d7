// SPDX-License-Identifier: Apache-2.0
// Files of a render: checked before hours of work, written after them.
#pragma once

#include <string>
#include <vector>

#include "apps/cli/console.h"
#include "apps/request/file_names.h"
#include "apps/state/finished_film.h"
#include "core/film/film.h"
#include "io/base/notice.h"
#include "io/file/rescue.h"

namespace petzval::apps {

/// Refuses files that could not be written, and those that are read. Adds the names to the request,
/// so that a scene which reads one of them is refused. Throws OutputError and ArgumentError.
void check_outputs(RenderOrder&, const RenderFiles&);

/// Settles how a display shows the pictures, where one of them is for a display. Returns what to
/// tell about it. Throws ValueError.
[[nodiscard]] std::vector<std::string> settle_display(RenderOrder&, const RenderFiles&);

/// Writes all pictures, whichever of them fail; each failure is told. stopped: unfinished ones,
/// NAME.partial.exr.
[[nodiscard]] std::vector<io::WriteOutcome> write_pictures(
    const std::vector<std::filesystem::path>&, const io::DisplayOptions&, const FinishedFilm&,
    bool stopped, Console&);

/// Whether a picture is there already that was made from the same command and inputs. Without
/// samples any number of them will do, as where a time limit decides.
[[nodiscard]] bool is_up_to_date(const std::filesystem::path&, const RenderFacts&,
                                 const io::FilmShape&, std::optional<SampleRange>);

}  // namespace petzval::apps
