// SPDX-License-Identifier: Apache-2.0
// Record of a run: what a state says beside its sums, so that the render can go on, be added to
// others, and be written as a picture.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/request/fields.h"
#include "apps/setup/stats_file.h"
#include "apps/state/render_facts.h"
#include "io/state/state_file.h"

namespace petzval::apps {

struct RunRecord {
    std::vector<FieldTexts> fields;  ///< of its order, where they are given
    std::filesystem::path folder;    ///< in which it runs
    RenderFacts facts;
    io::DisplayOptions display;
    RunFigures figures;  ///< so far, with those of the runs before
};

/// Header of a state with a record.
[[nodiscard]] io::StateHeader header_of(const RunRecord&, const io::FilmShape&, SampleRange);

/// Record in the header of a state. Throws InputError, which names the file, where the header has
/// none or another version of the program wrote it.
[[nodiscard]] RunRecord record_in(const io::StateHeader&, const std::filesystem::path& file);

/// "37 % of its samples", rounded down, or "12 samples of each pixel" where time decides.
[[nodiscard]] std::string share_text(const io::StateHeader&);

}  // namespace petzval::apps
