// SPDX-License-Identifier: Apache-2.0
// State of a render under way: where it lies, whether its samples are taken up, when it goes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/request/file_names.h"
#include "apps/state/run_record.h"
#include "core/film/film.h"
#include "io/base/notice.h"

namespace petzval::apps {

/// State of one render.
class KeptState {
  public:
    /// resumed_from: a state whose samples it goes on from, and where it is written. Throws
    /// ArgumentError rather than overwrite a file that is not an unfinished state of this render,
    /// unless the user asks for it.
    KeptState(const RenderOrder&, RenderFiles files,
              const std::optional<std::filesystem::path>& resumed_from);

    [[nodiscard]] const RenderFiles& files() const { return files_; }

    /// Sets the shape, samples and facts of the render, once they are known.
    void set(io::FilmShape, SampleRange, RenderFacts, const io::DisplayOptions&);
    [[nodiscard]] const RunRecord& record() const { return record_; }

    /// Film with the samples of the state, where there are some to go on from; the figures of the
    /// runs before are those of the record then. Nothing where there are none. Throws InputError
    /// where a resumed state does not fit.
    [[nodiscard]] std::optional<Film> take_up(Compare, const io::Notice&);

    /// Writes the samples so far, with the figures of this run, to a file. Throws OutputError.
    /// finished: of a render to a noise, that nothing is left to render.
    void write(const std::filesystem::path&, const Film&, const RunFigures&, SampleRange,
               bool finished = false);
    /// Removes what this run and those before wrote, of a render whose pictures are there.
    void remove_unfinished(const std::vector<std::filesystem::path>& pictures) const;

  private:
    RenderFiles files_;
    bool resumed_ = false, skips_existing_ = false;
    io::FilmShape shape_;
    SampleRange samples_;
    RunRecord record_;  ///< figures: of the runs before
    bool goes_on_ = false, was_complete_ = false, wrote_ = false;
};

}  // namespace petzval::apps
