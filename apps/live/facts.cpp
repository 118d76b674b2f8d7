// SPDX-License-Identifier: Apache-2.0
#include "apps/live/facts.h"

#include <array>
#include <cmath>

#include "apps/request/option_text.h"
#include "io/image/display.h"
#include "io/lens/lens_file.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, 6> kStageNames{"idle",    "preparing", "rough",
                                                 "growing", "done",      "failed"};

const char* kind_of(const RequestField& field) {
    if (field.form == FieldForm::Switch) return "switch";
    return field.form == FieldForm::List ? "list" : "value";
}

Json lens_facts() {
    Json out = Json::array();
    for (const io::LensSummary& lens : io::list_lenses())
        out.push_back({{"name", lens.name},
                       {"title", lens.title},
                       {"patent", lens.patent},
                       {"focal_length_mm", lens.focal_length_mm},
                       {"fstop", lens.fnumber},
                       {"angle_deg", 2 * lens.field_half_deg},
                       {"image_circle_mm", lens.image_circle_mm},
                       {"year", lens.year}});
    return out;
}

Json camera_facts(const LiveCamera& camera) {
    return {{"pose", camera.pose},
            {"focus_m", number_or_null(camera.focus_m)},
            {"sensor_mm", {camera.sensor_mm.x, camera.sensor_mm.y}},
            {"yfov_deg", camera.yfov_deg},
            {"camera", camera.of_file},
            {"middle_m", camera.middle_m ? number_or_null(*camera.middle_m) : Json(nullptr)}};
}

}  // namespace

Json number_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json program_facts(const PageRules& rules) {
    Json fields = Json::array();
    for (const RequestField& field : request_fields())
        if (is_for_pages(field))
            fields.push_back({{"name", field.name},
                              {"kind", kind_of(field)},
                              {"group", field.group},
                              {"help", as_options(field.help)}});
    return {{"scene", rules.start.render.scene.scene.filename().string()},
            {"start", fields_for_page(rules.start)},
            {"fields", std::move(fields)},
            {"lenses", lens_facts()},
            {"views", io::display_views(rules.start.render.display.config)}};
}

Json scene_facts(const LoadedScene& loaded) {
    if (!loaded.prepared.scene) return nullptr;
    Json cameras = Json::array(), animations = Json::array();
    for (const io::GltfCamera& camera : *loaded.prepared.cameras) cameras.push_back(camera.name);
    const io::GltfSummary& holds = *loaded.prepared.holds;
    for (const io::GltfSummary::Animation& one : holds.animations)
        animations.push_back(
            {{"name", one.name}, {"duration_s", number_or_null(one.duration_s.value_or(NAN))}});
    return {{"cameras", std::move(cameras)},
            {"animations", std::move(animations)},
            {"variants", holds.variants}};
}

Json status_facts(const LiveStatus& status) {
    Json notices = Json::array();
    for (const std::string& notice : status.notices) notices.push_back(as_options(notice));
    return {{"number", status.number},
            {"version", status.version},
            {"stage", kStageNames[static_cast<size_t>(status.stage)]},
            {"phase", kPhaseNames[static_cast<size_t>(status.phase)]},
            {"picture", status.picture},
            {"samples", status.samples},
            {"of", status.of},
            {"noise", status.noise},
            {"elapsed_s", status.elapsed_s},
            {"camera", status.camera ? camera_facts(*status.camera) : Json(nullptr)},
            {"channels", status.channels},
            {"notices", std::move(notices)},
            {"error", as_options(status.error)}};
}

std::string text_of(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace petzval::apps
