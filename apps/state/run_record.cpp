// SPDX-License-Identifier: Apache-2.0
#include "apps/state/run_record.h"

#include <fmt/format.h>

#include "io/base/error.h"
#include "io/build/build.h"

namespace petzval {
namespace {

using Json = nlohmann::ordered_json;

// A word of a command line: text, or bytes where it is no UTF-8, which JSON demands.
Json json_of_word(const std::string& word) {
    try {
        static_cast<void>(Json(word).dump());
        return word;
    } catch (const Json::type_error&) {
        return std::vector<uint8_t>(word.begin(), word.end());
    }
}

std::string word_from(const Json& json) {
    if (json.is_string()) return json.get<std::string>();
    const auto bytes = json.get<std::vector<uint8_t>>();
    return {bytes.begin(), bytes.end()};
}

}  // namespace

StateHeader header_of(const RunRecord& record, const FilmShape& shape, SampleRange samples) {
    Json words = Json::array();
    for (const std::string& word : record.command) words.push_back(json_of_word(word));
    return {shape,
            samples,
            0,
            {{"program", program_version()},
             {"command", std::move(words)},
             {"folder", json_of_word(record.folder.string())},
             {"facts", to_json(record.facts)},
             {"display",
              {record.display.exposure_ev, json_of_word(record.display.view),
               json_of_word(record.display.config.string())}},
             {"figures", to_json(record.figures)}}};
}

RunRecord record_in(const StateHeader& header, const std::filesystem::path& file) {
    const Json& run = header.run;
    RunRecord record;
    try {
        if (const auto program = run.at("program").get<std::string>(); program != program_version())
            throw InputError(file.string(), "",
                             "was written by {}, and this is {}: samples of both are "
                             "not of one picture; use the one that wrote it",
                             program, program_version());
        for (const Json& word : run.at("command")) record.command.push_back(word_from(word));
        record.folder = word_from(run.at("folder"));
        record.facts = facts_from(run.at("facts"));
        const Json& display = run.at("display");
        record.display = {display.at(0).get<float>(), word_from(display.at(1)),
                          word_from(display.at(2))};
        record.figures = figures_from(run.at("figures"));
    } catch (const nlohmann::json::exception&) {
        throw InputError(file.string(), "", "is damaged: its header says too little of its render");
    }
    return record;
}

std::string share_text(const StateHeader& header) {
    const uint64_t pixels = header.wanted() / header.samples.count();
    if (header.samples.count() >= kUnboundedSamples)
        return fmt::format("{} samples of each pixel", header.pixel_samples / pixels);
    const double share = double(header.pixel_samples) / double(header.wanted());
    return fmt::format("{} % of its samples", static_cast<int>(100 * share));
}

}  // namespace petzval
