// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render_sequence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <utility>

#include "apps/commands/failure.h"
#include "apps/commands/render_one.h"
#include "apps/request/sequence.h"
#include "io/base/error.h"
#include "io/image/sheet.h"

namespace petzval::apps {
namespace {

// Makes what the first picture found hold in the order of all; without the view and the focus where
// the sweep is over where the camera stands.
void hold(const FoundChoices& found, RenderOrder& all) {
    constexpr std::array<std::string_view, 4> kPlaces{"camera", "look-at", "orbit", "focus"};
    if (found.exposure_ev) all.render.display.exposure = ExposureRequest{false, *found.exposure_ev};
    const auto& sweep = all.sequence.sweep;
    if (sweep && std::ranges::find(kPlaces, sweep->field) != kPlaces.end()) return;
    CameraRequest& camera = all.render.scene.camera;
    if (found.look_at) camera.look_at = found.look_at;
    if (found.orbit_about) camera.orbit_about = found.orbit_about;
    if (found.focus) camera.focus = found.focus;
}

/// A sequence under way.
class Sequence {
  public:
    Sequence(const RenderOrder& order, const io::Notice& notice, Session& session)
        : all_(order), notice_(notice), session_(session), items_(items_of(order.sequence)) {
        const bool frames = !order.sequence.frames.empty();
        if (frames) place_.frames = RenderSession::Frames::Sequence;
        // What is wrong with one ends all at once. Frames differ in a number only.
        const size_t checked = frames ? 1 : items_.size();
        for (size_t i = 0; i < checked; ++i) check_one(items_[i]);
        if (!order.sequence.sheet) return;
        io::SheetOptions options;
        constexpr size_t kMostInARow = 3;  // so few are to be compared
        if (items_.size() <= kMostInARow) options.columns = static_cast<int>(items_.size());
        io::check_sheet(*order.sequence.sheet, options);
        sheet_.emplace(items_.size(), options);
    }
    int run();

  private:
    [[nodiscard]] RenderOrder order_for(const SequenceItem& item) const {
        return order_of(item, all_, items_.size() > 1);
    }
    void check_one(const SequenceItem& item) const {
        const RenderOrder one = order_for(item);
        check(one);
        static_cast<void>(resolved_scene(one.render));
    }
    [[nodiscard]] int render(size_t i);
    [[nodiscard]] int write_sheet() const;

    RenderOrder all_;
    const io::Notice& notice_;
    Session& session_;
    std::vector<SequenceItem> items_;
    SequencePlace place_;
    std::optional<io::ContactSheet> sheet_;
    bool holds_ = false;    ///< what the first picture that was set up found
    bool for_srgb_ = true;  ///< what the sheet shows
    std::set<std::string> said_;
};

int Sequence::render(size_t i) {
    const SequenceItem& item = items_[i];
    const bool several = items_.size() > 1;
    const io::Notice once = [&](const std::string& text) {
        if (said_.insert(text).second) notice_(text);
    };
    bool shown = false;
    const auto leave_cell = [&] {
        if (sheet_ && !shown) sheet_->add_missing(item.label);
    };
    try {
        place_.part_of = {static_cast<int>(i), static_cast<int>(items_.size())};
        if (sheet_)
            place_.show = [&](const io::PictureRows& picture, const io::DisplayOptions& display) {
                sheet_->add(picture, item.label);
                for_srgb_ = display.config.empty();
                shown = true;
            };
        const int code = render_one(order_for(item), {}, once, session_, place_);
        if (!std::exchange(holds_, true)) hold(place_.found, all_);
        leave_cell();
        return code;
    } catch (...) {
        leave_cell();
        return tell_failure(session_, several ? item.label : "");
    }
}

int Sequence::write_sheet() const {
    const io::WriteOutcome sheet =
        io::write_or_rescue(*all_.sequence.sheet,
                            [&](const std::filesystem::path& to) { sheet_->write(to, for_srgb_); });
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
        if (one != kNoiseLeft) failed.push_back(items_[i].label);
    }
    if (!failed.empty() && items_.size() > 1)
        session_.console.error(fmt::format("{} of {} pictures failed: {}", failed.size(),
                                           items_.size(), fmt::join(failed, ", ")));
    if (sheet_ && code != kStopped && failed.size() < items_.size())  // else one may be there
        if (const int written = write_sheet(); code == kSuccess) code = written;
    return code;
}

}  // namespace

int render_sequence(const RenderOrder& order, const io::Notice& notice, Session& session) {
    return Sequence(order, notice, session).run();
}

}  // namespace petzval::apps
