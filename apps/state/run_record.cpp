// SPDX-License-Identifier: Apache-2.0
#include "apps/state/run_record.h"

#include <fmt/format.h>

#include "io/base/error.h"
#include "io/build/build.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::ordered_json;

// A text, as bytes where it is no UTF-8, which JSON demands.
Json json_of_text(const std::string& text) {
    try {
        static_cast<void>(Json(text).dump());
        return text;
    } catch (const Json::type_error&) {
        return std::vector<uint8_t>(text.begin(), text.end());
    }
}

std::string text_from(const Json& json) {
    if (json.is_string()) return json.get<std::string>();
    const auto bytes = json.get<std::vector<uint8_t>>();
    return {bytes.begin(), bytes.end()};
}

}  // namespace

io::StateHeader header_of(const RunRecord& record, const io::FilmShape& shape,
                          SampleRange samples) {
    Json fields = Json::array();
    for (const auto& [name, texts] : record.fields) {
        Json values = Json::array();
        for (const std::string& text : texts) values.push_back(json_of_text(text));
        fields.push_back({name, std::move(values)});
    }
    return {shape,
            samples,
            0,
            {{"program", io::program_version()},
             {"request", std::move(fields)},
             {"folder", json_of_text(record.folder.string())},
             {"facts", to_json(record.facts)},
             {"display",
              {record.display.exposure_ev, json_of_text(record.display.view),
               json_of_text(record.display.config.string())}},
             {"figures", to_json(record.figures)}}};
}

RunRecord record_in(const io::StateHeader& header, const std::filesystem::path& file) {
    const Json& run = header.run;
    RunRecord record;
    try {
        if (const auto program = run.at("program").get<std::string>();
            program != io::program_version())
            throw io::InputError(file.string(), "",
                                 "was written by {}, and this is {}: samples of both are "
                                 "not of one picture; use the one that wrote it",
                                 program, io::program_version());
        for (const Json& field : run.at("request")) {
            FieldTexts& one = record.fields.emplace_back();
            field.at(0).get_to(one.name);
            for (const Json& text : field.at(1)) one.texts.push_back(text_from(text));
        }
        record.folder = text_from(run.at("folder"));
        record.facts = facts_from(run.at("facts"));
        const Json& display = run.at("display");
        record.display = {display.at(0).get<float>(), text_from(display.at(1)),
                          text_from(display.at(2))};
        record.figures = figures_from(run.at("figures"));
    } catch (const nlohmann::json::exception&) {
        throw io::InputError(file.string(), "",
                             "is damaged: its header says too little of its render");
    }
    return record;
}

std::string share_text(const io::StateHeader& header) {
    const uint64_t pixels = header.wanted() / header.samples.count();
    if (header.samples.count() >= kMostSamples)
        return fmt::format("{} samples of each pixel", header.pixel_samples / pixels);
    const double share = double(header.pixel_samples) / double(header.wanted());
    return fmt::format("{} % of its samples", static_cast<int>(100 * share));
}

}  // namespace petzval::apps
