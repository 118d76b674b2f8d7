// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/kept_state.h"

#include <fmt/format.h>

#include <utility>

#include "io/base/error.h"
#include "io/base/printable.h"
#include "io/image/output.h"

namespace petzval::apps {

namespace fs = std::filesystem;

namespace {

// Refuses to put a checkpoint in the place of what is none.
void refuse_loss(const fs::path& file) {
    const auto refuse = [&](const char* what) {
        return io::ArgumentError(file.string(), "",
                                 "{}, and a checkpoint would take its place; move it, name "
                                 "another by -o NAME.state, or give --checkpoint off",
                                 what);
    };
    std::optional<io::StateHeader> there;
    try {
        there = io::StateReader(file).header();
    } catch (const io::InputError&) {
        throw refuse("is there, and is no state of this program's");
    }
    if (there->is_complete())
        throw refuse("has finished samples, whose pictures petzval resume writes");
}

}  // namespace

KeptState::KeptState(const RenderOrder& order, RenderFiles files,
                     const std::optional<fs::path>& resumed_from)
    : files_(std::move(files)),
      resumed_(resumed_from.has_value()),
      skips_existing_(order.run.skip_existing) {
    RenderOrder alone = order;
    alone.sequence = {};
    record_.fields = fields_of(alone);
    std::error_code error;
    record_.folder = fs::current_path(error);
    if (resumed_) files_.state = resumed_from;
    if (files_.state && !files_.state_stays && !resumed_ && !skips_existing_ &&
        fs::exists(*files_.state, error))
        refuse_loss(*files_.state);
}

void KeptState::set(io::FilmShape shape, SampleRange samples, RenderFacts facts,
                    const io::DisplayOptions& display) {
    shape_ = std::move(shape);
    samples_ = samples;
    record_.facts = std::move(facts);
    record_.display = display;
    if (auto& config = record_.display.config; !config.empty()) config = fs::absolute(config);
}

std::optional<Film> KeptState::take_up(Compare compare, const io::Notice& notice) {
    const auto& file = files_.state;
    std::error_code error;
    if (!file || !fs::exists(*file, error)) return std::nullopt;
    if (!resumed_ && !skips_existing_) {
        if (!files_.state_stays)
            notice(
                fmt::format("warning: {} is there from a render before, and the first checkpoint "
                            "takes its place; petzval resume {} would go on with that one",
                            file->string(), io::for_shell(file->string())));
        return std::nullopt;
    }
    try {
        io::StateReader reader(*file);
        const io::StateHeader& header = reader.header();
        const RunRecord before = record_in(header, *file);
        const auto differs = difference({before.facts, header.shape, "the state"},
                                        {record_.facts, shape_, "what it would be now"}, compare);
        if (differs || header.samples != samples_ || header.shape.crop != shape_.crop)
            throw io::InputError(file->string(), "",
                                 differs ? "does not go on: something has changed: " + *differs
                                         : "is of other samples or another crop");
        Film film = shape_.empty_film();
        reader.add_to(film);
        goes_on_ = true;
        was_complete_ = header.is_complete();
        record_.figures = before.figures;
        notice(fmt::format("goes on with {}, which has {}", file->string(), share_text(header)));
        return film;
    } catch (const io::InputError& refused) {
        if (resumed_) throw;
        if (!files_.state_stays) refuse_loss(*file);
        notice(fmt::format("warning: {}; it will be replaced", refused.what()));
        return std::nullopt;
    }
}

void KeptState::write(const fs::path& to, const Film& film, const RunFigures& now,
                      SampleRange samples, bool finished) {
    RunRecord record = record_;
    record.figures += now;
    io::StateHeader header = header_of(record, shape_, samples);
    header.is_finished = finished;
    io::write_state(to, std::move(header), film);
    wrote_ = true;
}

void KeptState::remove_unfinished(const std::vector<fs::path>& pictures) const {
    std::error_code error;
    // A state that was complete may be somebody's part of a picture.
    const bool of_others = was_complete_ && !resumed_;
    if (files_.state && !files_.state_stays && (wrote_ || goes_on_) && !of_others)
        fs::remove(*files_.state, error);
    if (!goes_on_) return;
    for (const fs::path& picture : pictures) fs::remove(io::partial_name(picture), error);
}

}  // namespace petzval::apps
