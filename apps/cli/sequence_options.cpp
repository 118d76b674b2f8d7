// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/sequence_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>

#include "apps/cli/quantity.h"

namespace petzval {
namespace {

constexpr int kMostViews = 100'000;
constexpr std::array<const char*, 3> kSequences{"--frames", "--turntable", "--sweep"};

std::vector<SequenceItem> frame_items(const std::string& frames) {
    std::vector<SequenceItem> items;
    for (const int frame : parse_frames("--frames", frames))
        items.push_back(
            {{"--at", fmt::format("frame:{}", frame)}, frame, fmt::format("frame {}", frame)});
    return items;
}

std::vector<SequenceItem> view_items(int count) {
    std::vector<SequenceItem> items;
    for (int i = 0; i < count; ++i) {
        const std::string angle_deg = fmt::format("{:.9g}", 360. * i / count);
        items.push_back({{"--orbit", angle_deg}, i + 1, angle_deg + "°"});
    }
    return items;
}

std::vector<SequenceItem> sweep_items(const std::string& sweep) {
    const auto refuse = [&] {
        return CLI::ValidationError(
            "--sweep", fmt::format("\"{}\" is not an option and its values, as fstop=1.4,2,2.8; "
                                   "with semicolons between values that hold commas",
                                   sweep));
    };
    const size_t at = sweep.find('=');
    if (at == sweep.npos || at == 0) throw refuse();
    const std::string option = sweep.substr(0, at), values = sweep.substr(at + 1);
    constexpr std::array<std::string_view, 13> kNoSweep{
        "output",  "stats",  "sweep",      "frames", "turntable", "sheet", "log",
        "preview", "number", "checkpoint", "help",   "progress",  "quiet"};
    if (option.starts_with('-')) throw refuse();
    if (std::ranges::find(kNoSweep, option) != kNoSweep.end())
        throw CLI::ValidationError(
            "--sweep", option + " is the same for all pictures; sweep what changes the picture");
    std::vector<SequenceItem> items;
    for (const std::string_view part : split(values, values.find(';') == values.npos ? ',' : ';')) {
        const std::string value(trimmed(part));
        if (value.empty()) throw refuse();
        items.push_back({{"--" + option + "=" + value},
                         static_cast<int>(items.size()) + 1,
                         option + " " + value});
    }
    return items;
}

}  // namespace

void add_sequence_options(CLI::App& app, SequenceOptions& o) {
    const auto add = [&](const char* name, auto& value, const char* help) {
        return app.add_option(name, value, help)->group("Sequences");
    };
    auto* frames = add("--frames", o.frames,
                       "frames of --fps, as 1:48 or 1:48:2; #### in the names of files becomes "
                       "their number")
                       ->excludes(app.get_option("--at"));
    auto* turntable =
        add("--turntable", o.turntable, "this number of views, evenly spaced around the scene")
            ->transform(whole_number_between(1, kMostViews))
            ->excludes(frames)
            ->excludes(app.get_option("--orbit"));
    add("--sweep", o.sweep,
        "a picture for each value of an option: fstop=1.4,2,2.8 or lens=NAME,NAME")
        ->excludes(frames)
        ->excludes(turntable);
    add("--sheet", o.sheet, "all pictures side by side with labels, as .png or .jpg")
        ->each([output = app.get_option("--output")](const std::string&) {
            output->required(false);  // the sheet is one
        });
    app.add_option("--number", o.number, "")->group("");  // of one picture of a sequence
}

std::vector<SequenceItem> items_of(const SequenceOptions& o) {
    if (o.turntable) return view_items(*o.turntable);
    return o.frames.empty() ? sweep_items(o.sweep) : frame_items(o.frames);
}

std::string swept_option(const SequenceOptions& o) {
    return o.sweep.substr(0, o.sweep.find('='));
}

std::vector<std::string> with_words(std::vector<std::string> words,
                                    const std::vector<std::string>& added) {
    words.insert(std::find(words.begin(), words.end(), "--"), added.begin(), added.end());
    return words;
}

std::vector<std::string> without_sequence(const std::vector<std::string>& words) {
    std::vector<std::string> out;
    for (size_t i = 0; i < words.size(); ++i) {
        const auto is_sequence = [&](const char* option) { return words[i] == option; };
        const auto has_value = [&](const char* option) {
            return words[i].starts_with(std::string(option) + "=");
        };
        if (std::ranges::any_of(kSequences, is_sequence))
            ++i;
        else if (!std::ranges::any_of(kSequences, has_value))
            out.push_back(words[i]);
    }
    return out;
}

std::vector<int> parse_frames(const std::string& option, const std::string& text) {
    constexpr int kMostFrames = 100'000, kLastFrame = 10'000'000;
    std::vector<int> numbers;
    for (const std::string_view part : split(text, ':'))
        numbers.push_back(number<int>(trimmed(part)).value_or(-1));
    const bool right =
        numbers.size() <= 3 && std::all_of(numbers.begin(), numbers.end(),
                                           [](int n) { return n >= 0 && n <= kLastFrame; });
    const int first = numbers[0], last = numbers.size() > 1 ? numbers[1] : first,
              step = numbers.size() > 2 ? numbers[2] : 1;
    if (!right || last < first || step < 1 || (last - first) / step >= kMostFrames)
        throw CLI::ValidationError(
            option, fmt::format("\"{}\" is not a range of frames such as 1:48, 1:48:2 or 7, {} at "
                                "most",
                                text, kMostFrames));
    std::vector<int> frames;
    for (int frame = first; frame <= last; frame += step) frames.push_back(frame);
    return frames;
}

std::filesystem::path name_of_frame(const std::string& option, const std::filesystem::path& path,
                                    int frame, bool several) {
    const std::string name = path.filename().string();
    const size_t end = name.find_last_of('#');
    if (end == name.npos) {
        if (!several) return path;
        throw CLI::ValidationError(
            option,
            fmt::format("\"{}\" names one file for all frames; put #### where their numbers "
                        "go",
                        path.string()));
    }
    const size_t before = name.find_last_not_of('#', end);
    const size_t begin = before == name.npos ? 0 : before + 1;
    return path.parent_path() / fmt::format("{}{:0{}}{}", name.substr(0, begin), frame,
                                            end + 1 - begin, name.substr(end + 1));
}

}  // namespace petzval
