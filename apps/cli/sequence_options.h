// SPDX-License-Identifier: Apache-2.0
// Options of a sequence of pictures, and the names of their files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace petzval {

/// Sequence options as given.
struct SequenceOptions {
    std::string frames, sweep;     ///< empty: absent
    std::optional<int> turntable;  ///< number of views
    std::optional<std::filesystem::path> sheet;
    std::optional<int> number;  ///< of one picture: what #### in the names of files becomes

    [[nodiscard]] bool several() const { return !frames.empty() || !sweep.empty() || turntable; }
};

/// One picture of a sequence.
struct SequenceItem {
    std::vector<std::string> words;  ///< that are added to those of the sequence
    int number;                      ///< in the names of its files
    std::string label;               ///< "frame 12", "fstop 1.4"
};

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_sequence_options(CLI::App&, SequenceOptions&);

/// Pictures that are asked for. Throws CLI::ValidationError.
[[nodiscard]] std::vector<SequenceItem> items_of(const SequenceOptions&);

/// Option that a sweep is over, as "fstop"; empty where there is none.
[[nodiscard]] std::string swept_option(const SequenceOptions&);

/// Words of a command line with some that are added: they count as the last ones, before a "--".
[[nodiscard]] std::vector<std::string> with_words(std::vector<std::string> words,
                                                  const std::vector<std::string>& added);

/// Words of a command line without the options that make a sequence of it.
[[nodiscard]] std::vector<std::string> without_sequence(const std::vector<std::string>& words);

/// Numbers of frames from "1:48" (both are rendered), "1:48:2" (every second one) or "7": whole
/// numbers from 0, at most 100,000 of them. Throws CLI::ValidationError.
[[nodiscard]] std::vector<int> parse_frames(const std::string& option, const std::string& text);

/// Name of a frame's file: the last run of # becomes the number, with zeros up to its length.
/// Throws CLI::ValidationError where there is no # but several frames.
[[nodiscard]] std::filesystem::path name_of_frame(const std::string& option,
                                                  const std::filesystem::path&, int frame,
                                                  bool several);

}  // namespace petzval
