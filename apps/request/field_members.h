// SPDX-License-Identifier: Apache-2.0
// Members of an order, by the structure that they are in: what the kinds of fields read and write.
#pragma once

#include "apps/request/render_order.h"

namespace petzval::apps::in {

template <class T>
auto render(T RenderRequest::*member) {
    return [=](auto& order) -> auto& {
        return order.render.*member;
    };
}
template <class T>
auto scene(T SceneRequest::*member) {
    return [=](auto& order) -> auto& {
        return order.render.scene.*member;
    };
}
template <class T>
auto file(T io::GltfChoices::*member) {
    return [=](auto& order) -> auto& {
        return order.render.scene.choices.*member;
    };
}
template <class T>
auto camera(T CameraRequest::*member) {
    return [=](auto& order) -> auto& {
        return order.render.scene.camera.*member;
    };
}
template <class T>
auto spectral(T SpectralRequest::*member) {
    return [=](auto& order) -> auto& {
        return order.render.scene.spectral.*member;
    };
}
template <class T>
auto moment(T MomentRequest::*member) {
    return [=](auto& order) -> auto& {
        return order.render.moment.*member;
    };
}
template <class T>
auto samples(T SampleRequest::*member) {
    return [=](auto& order) -> auto& {
        return order.render.samples.*member;
    };
}
template <class T>
auto path(T integrator::PathOptions::*member) {
    return [=](auto& order) -> auto& {
        return order.render.path.*member;
    };
}
template <class T>
auto display(T DisplayRequest::*member) {
    return [=](auto& order) -> auto& {
        return order.render.display.*member;
    };
}
template <class T>
auto run(T RunRequest::*member) {
    return [=](auto& order) -> auto& {
        return order.run.*member;
    };
}
template <class T>
auto sequence(T SequenceRequest::*member) {
    return [=](auto& order) -> auto& {
        return order.sequence.*member;
    };
}

}  // namespace petzval::apps::in
