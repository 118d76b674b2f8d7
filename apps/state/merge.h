// SPDX-License-Identifier: Apache-2.0
// Merging of states: parts of the samples, or of the frame, of one render.
#pragma once

#include <filesystem>
#include <vector>

#include "apps/state/run_record.h"
#include "core/film/film.h"

namespace petzval::apps {

/// Samples of a part of a frame.
struct StateBox {
    Rect crop;
    SampleRange samples;
};

/// Throws InputError where boxes overlap, or do not fill the smallest box that holds them all, and
/// says by the names of their files which, or what is missing. The box that they fill.
[[nodiscard]] StateBox covered_box(const std::vector<StateBox>&,
                                   const std::vector<std::filesystem::path>& names);

/// Sum of states.
struct MergedState {
    Film film;
    SampleRange samples;
    RunRecord record;  ///< of the first, with the figures of all
};

/// Adds states, one after the other: there is memory for one film. Throws InputError where one is
/// not complete, or they are not the parts of one render: the message names the files and what
/// differs.
[[nodiscard]] MergedState merge_states(const std::vector<std::filesystem::path>&);

}  // namespace petzval::apps
