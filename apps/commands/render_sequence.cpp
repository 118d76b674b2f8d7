// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/render_sequence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <set>

#include "apps/cli/frames.h"
#include "apps/commands/failure.h"
#include "apps/commands/render.h"
#include "apps/commands/render_one.h"

namespace petzval {
namespace {

using Words = std::vector<std::string>;

/// One picture of a sequence.
struct Item {
    Words words;        ///< that are added to those of the sequence
    int number;         ///< in the names of its files
    std::string label;  ///< "frame 12"
};

std::vector<Item> items_of(const RenderOptions& o) {
    std::vector<Item> items;
    for (const int frame : parse_frames("--frames", o.frames))
        items.push_back(
            {{"--at", fmt::format("frame:{}", frame)}, frame, fmt::format("frame {}", frame)});
    return items;
}

// Words without an option and its value.
Words without(const Words& words, const std::string& option) {
    Words out;
    for (size_t i = 0; i < words.size(); ++i) {
        if (words[i] == option)
            ++i;
        else if (!words[i].starts_with(option + "="))
            out.push_back(words[i]);
    }
    return out;
}

// Refuses names of files that all pictures would share.
void check_names(const RenderOptions& o, const std::vector<Item>& items) {
    if (items.size() < 2) return;
    for (const auto& output : o.outputs) static_cast<void>(name_of_frame("-o", output, 0, true));
    if (o.stats) static_cast<void>(name_of_frame("--stats", *o.stats, 0, true));
}

}  // namespace

bool is_sequence(const RenderOptions& o) {
    return !o.frames.empty();
}

int render_sequence(const RenderOptions& o, const Notice& notice, Session& session) {
    const std::vector<Item> items = items_of(o);
    check_names(o, items);
    Words all = without(session.words, "--frames");
    std::set<std::string> said;
    const Notice once = [&](const std::string& text) {
        if (said.insert(text).second) notice(text);
    };
    const auto reuse = std::make_shared<FrameReuse>();
    std::vector<std::string> failed;
    int code = kSuccess;
    for (size_t i = 0; i < items.size() && session.interrupt.signal_name() == nullptr; ++i) {
        const Item& item = items[i];
        Words words = all;
        words.insert(words.end(), item.words.begin(), item.words.end());
        words.insert(words.end(), {"--number", fmt::format("{}", item.number)});
        if (items.size() > 1) notice(fmt::format("{}, {} of {}", item.label, i + 1, items.size()));
        int one = kFailure;
        try {
            const ParsedRender parsed = parse_render(words);
            parsed.options->scene.reuse = reuse;
            SequencePlace place;
            place.part_of = {int(i), int(items.size())};
            one = render_one(*parsed.options, words, once, session, place);
            if (i == 0) all.insert(all.end(), place.found.begin(), place.found.end());
        } catch (...) {
            one = tell_failure(session, items.size() > 1 ? item.label : "");
        }
        if (one == kSuccess) continue;
        if (code == kSuccess) code = one;
        if (one == kStopped) return kStopped;
        failed.push_back(item.label);
    }
    if (!failed.empty() && items.size() > 1)
        session.console.error(fmt::format("{} of {} pictures failed: {}", failed.size(),
                                          items.size(), fmt::join(failed, ", ")));
    return session.interrupt.signal_name() ? kStopped : code;
}

}  // namespace petzval
