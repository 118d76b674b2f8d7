// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render_sequence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <utility>

#include "apps/cli/sequence_options.h"
#include "apps/commands/failure.h"
#include "apps/commands/render.h"
#include "apps/commands/render_one.h"
#include "io/base/error.h"
#include "io/image/sheet.h"

namespace petzval {
namespace {

using Words = std::vector<std::string>;

// Refuses names of files that all pictures would share.
void check_names(const RenderOptions& o, size_t pictures) {
    if (pictures < 2) return;
    for (const auto& output : o.outputs) static_cast<void>(name_of_frame("-o", output, 0, true));
    if (o.stats) static_cast<void>(name_of_frame("--stats", *o.stats, 0, true));
}

// What the first picture found, without the focus where the sweep is over where the camera stands.
Words held(const Words& found, const std::string& swept) {
    constexpr std::array<std::string_view, 4> kPlaces{"camera", "look-at", "orbit", "focus"};
    if (std::ranges::find(kPlaces, swept) == kPlaces.end()) return found;
    Words out;
    for (size_t i = 0; i + 1 < found.size(); i += 2)
        if (found[i] == "--exposure") out.insert(out.end(), {found[i], found[i + 1]});
    return out;
}

/// A sequence under way.
class Sequence {
  public:
    Sequence(const RenderOptions& o, const Notice& notice, Session& session)
        : o_(o), notice_(notice), session_(session), items_(items_of(o.sequence)) {
        check_names(o, items_.size());
        all_ = without_sequence(session.words);
        if (!o.sequence.frames.empty()) place_.frames = RenderSession::Frames::Sequence;
        // What is wrong with one ends all at once. Frames differ in a number only.
        const size_t checked = o.sequence.frames.empty() ? items_.size() : 1;
        for (size_t i = 0; i < checked; ++i) {
            const ParsedRender parsed = parse_render(words_of(items_[i]));
            static_cast<void>(resolve(*parsed.options));
        }
        if (!o.sequence.sheet) return;
        SheetOptions options;
        constexpr size_t kMostInARow = 3;  // so few are to be compared
        if (items_.size() <= kMostInARow) options.columns = static_cast<int>(items_.size());
        check_sheet(*o.sequence.sheet, options);
        sheet_.emplace(items_.size(), options);
    }
    int run();

  private:
    [[nodiscard]] Words words_of(const SequenceItem& item) const {
        Words added = item.words;
        added.insert(added.end(), {"--number", fmt::format("{}", item.number)});
        return with_words(all_, added);
    }
    [[nodiscard]] int render(size_t i);
    void hold(const SequencePlace&);
    [[nodiscard]] int write_sheet() const;

    const RenderOptions& o_;
    const Notice& notice_;
    Session& session_;
    std::vector<SequenceItem> items_;
    Words all_;  ///< of every picture
    SequencePlace place_;
    std::optional<ContactSheet> sheet_;
    bool holds_ = false;    ///< what the first picture that was set up found
    bool for_srgb_ = true;  ///< what the sheet shows
    std::set<std::string> said_;
};

int Sequence::render(size_t i) {
    const SequenceItem& item = items_[i];
    const bool several = items_.size() > 1;
    const Notice once = [&](const std::string& text) {
        if (said_.insert(text).second) notice_(text);
    };
    bool shown = false;
    const auto leave_cell = [&] {
        if (sheet_ && !shown) sheet_->add_missing(item.label);
    };
    try {
        const Words words = words_of(item);
        const ParsedRender parsed = parse_render(words);
        place_.part_of = {static_cast<int>(i), static_cast<int>(items_.size())};
        if (sheet_)
            place_.show = [&](const PictureRows& picture, const DisplayOptions& display) {
                sheet_->add(picture, item.label);
                for_srgb_ = display.config.empty();
                shown = true;
            };
        const int code = render_one(*parsed.options, words, once, session_, place_);
        hold(place_);
        leave_cell();
        return code;
    } catch (...) {
        leave_cell();
        return tell_failure(session_, several ? item.label : "");
    }
}

// Makes what the first picture found hold for the others.
void Sequence::hold(const SequencePlace& place) {
    if (std::exchange(holds_, true)) return;
    all_ = with_words(all_, held(place.found, swept_option(o_.sequence)));
}

int Sequence::write_sheet() const {
    const WriteOutcome sheet = write_or_rescue(
        *o_.sequence.sheet, [&](const std::filesystem::path& to) { sheet_->write(to, for_srgb_); });
    if (sheet.written()) return kSuccess;
    session_.console.error(sheet.message());
    return kOutputFailed;
}

int Sequence::run() {
    std::vector<std::string> failed;
    int code = kSuccess;
    for (size_t i = 0; i < items_.size(); ++i) {
        if (session_.interrupt.signal_name() != nullptr) {
            code = kStopped;
            break;
        }
        if (items_.size() > 1)
            notice_(fmt::format("{}, {} of {}", items_[i].label, i + 1, items_.size()));
        const int one = render(i);
        if (one == kSuccess) continue;
        if (code == kSuccess || one == kStopped) code = one;
        if (one == kStopped) break;
        failed.push_back(items_[i].label);
    }
    if (!failed.empty() && items_.size() > 1)
        session_.console.error(fmt::format("{} of {} pictures failed: {}", failed.size(),
                                           items_.size(), fmt::join(failed, ", ")));
    if (sheet_ && code != kStopped && failed.size() < items_.size())  // else one may be there
        if (const int written = write_sheet(); code == kSuccess) code = written;
    return code;
}

}  // namespace

bool is_sequence(const RenderOptions& o) {
    return o.sequence.several();
}

int render_sequence(const RenderOptions& o, const Notice& notice, Session& session) {
    return Sequence(o, notice, session).run();
}

}  // namespace petzval
