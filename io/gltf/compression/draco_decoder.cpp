// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/compression/draco_decoder.h"

#include <draco/compression/attributes/sequential_attribute_decoders_controller.h>
#include <draco/compression/attributes/sequential_integer_attribute_decoder.h>
#include <draco/compression/attributes/sequential_quantization_attribute_decoder.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/compression/mesh/traverser/depth_first_traverser.h>
#include <draco/compression/mesh/traverser/max_prediction_degree_traverser.h>
#include <draco/compression/mesh/traverser/mesh_attribute_indices_encoding_observer.h>
#include <draco/compression/mesh/traverser/mesh_traversal_sequencer.h>

#include <cstring>
#include <stdexcept>

namespace petzval::io {
namespace {

/// A way of Draco's to predict values. The library believes the number of orientations of texture
/// coordinates: 2^31 of them take ten seconds. There is one for a corner at most. Two ways are no
/// longer in use.
class FencedPrediction : public draco::PredictionSchemeTypedDecoderInterface<int32_t> {
  public:
    using Prediction = draco::PredictionSchemeTypedDecoderInterface<int32_t>;

    FencedPrediction(std::unique_ptr<Prediction> inner, uint64_t corners)
        : inner_(std::move(inner)), corners_(corners) {}

    bool DecodePredictionData(draco::DecoderBuffer* buffer) override {
        const auto method = GetPredictionMethod();
        if (method == draco::MESH_PREDICTION_MULTI_PARALLELOGRAM ||
            method == draco::MESH_PREDICTION_TEX_COORDS_DEPRECATED)
            return false;
        uint32_t orientations = 0;
        if (method == draco::MESH_PREDICTION_TEX_COORDS_PORTABLE &&
            (!buffer->Peek(&orientations) || orientations > corners_))
            return false;
        return inner_->DecodePredictionData(buffer);
    }
    bool ComputeOriginalValues(const int32_t* corrections, int32_t* out, int size, int components,
                               const draco::PointIndex* points) override {
        return inner_->ComputeOriginalValues(corrections, out, size, components, points);
    }
    [[nodiscard]] draco::PredictionSchemeMethod GetPredictionMethod() const override {
        return inner_->GetPredictionMethod();
    }
    [[nodiscard]] const draco::PointAttribute* GetAttribute() const override {
        return inner_->GetAttribute();
    }
    [[nodiscard]] bool IsInitialized() const override { return inner_->IsInitialized(); }
    [[nodiscard]] int GetNumParentAttributes() const override {
        return inner_->GetNumParentAttributes();
    }
    [[nodiscard]] draco::GeometryAttribute::Type GetParentAttributeType(int i) const override {
        return inner_->GetParentAttributeType(i);
    }
    bool SetParentAttribute(const draco::PointAttribute* attribute) override {
        return inner_->SetParentAttribute(attribute);
    }
    bool AreCorrectionsPositive() override { return inner_->AreCorrectionsPositive(); }
    [[nodiscard]] draco::PredictionSchemeTransformType GetTransformType() const override {
        return inner_->GetTransformType();
    }

  private:
    std::unique_ptr<Prediction> inner_;
    uint64_t corners_;
};

/// A decoder of an attribute that fences its prediction.
template <class Decoder>
class FencedAttribute : public Decoder {
    std::unique_ptr<FencedPrediction::Prediction> CreateIntPredictionScheme(
        draco::PredictionSchemeMethod method,
        draco::PredictionSchemeTransformType transform) override {
        // The library takes any byte of the file for a method.
        std::underlying_type_t<draco::PredictionSchemeMethod> number;
        std::memcpy(&number, &method, sizeof number);
        if (number < draco::PREDICTION_NONE || number >= draco::NUM_PREDICTION_SCHEMES)
            return nullptr;
        auto prediction = Decoder::CreateIntPredictionScheme(method, transform);
        if (!prediction) return nullptr;
        const auto* mesh = static_cast<const draco::MeshDecoder*>(this->decoder())->mesh();
        return std::make_unique<FencedPrediction>(std::move(prediction),
                                                  3 * uint64_t(mesh->num_faces()));
    }
};

/// The order in which a decoder of attributes takes the vertices of a mesh of the edgebreaker. It
/// is as the library makes it, but made when it is asked for: then the tables are known.
class Sequencer : public draco::PointsSequencer {
  public:
    Sequencer(draco::MeshDecoder& decoder, int id, bool at_vertices, bool by_degree)
        : decoder_(decoder), id_(id), at_vertices_(at_vertices), by_degree_(by_degree) {}

    bool UpdatePointToAttributeIndexMapping(draco::PointAttribute* attribute) override {
        return inner_->UpdatePointToAttributeIndexMapping(attribute);
    }

  private:
    bool GenerateSequenceInternal() override {
        using Corners = draco::MeshAttributeCornerTable;
        const int attribute = decoder_.attributes_decoder(id_)->GetAttributeId(0);
        if (!at_vertices_)
            make<draco::DepthFirstTraverser, Corners>(decoder_.GetAttributeCornerTable(attribute));
        else if (by_degree_)
            make<draco::MaxPredictionDegreeTraverser, draco::CornerTable>(
                decoder_.GetCornerTable());
        else
            make<draco::DepthFirstTraverser, draco::CornerTable>(decoder_.GetCornerTable());
        return inner_ && inner_->GenerateSequence(out_point_ids());
    }

    template <template <class, class> class Traverser, class Table>
    void make(const Table* table) {
        if (!table) return;
        using Observer = draco::MeshAttributeIndicesEncodingObserver<Table>;
        const int attribute = decoder_.attributes_decoder(id_)->GetAttributeId(0);
        auto* data = const_cast<draco::MeshAttributeIndicesEncodingData*>(
            decoder_.GetAttributeEncodingData(attribute));
        auto sequencer =
            std::make_unique<draco::MeshTraversalSequencer<Traverser<Table, Observer>>>(
                decoder_.mesh(), data);
        Traverser<Table, Observer> traverser;
        traverser.Init(table, Observer(table, decoder_.mesh(), sequencer.get(), data));
        sequencer->SetTraverser(traverser);
        inner_ = std::move(sequencer);
    }

    draco::MeshDecoder& decoder_;
    int id_;
    bool at_vertices_, by_degree_;
    std::unique_ptr<draco::PointsSequencer> inner_;
};

/// Decoders of attributes, of which those that predict are fenced.
class Controller : public draco::SequentialAttributeDecodersController {
  public:
    using SequentialAttributeDecodersController::SequentialAttributeDecodersController;

  private:
    std::unique_ptr<draco::SequentialAttributeDecoder> CreateSequentialDecoder(
        uint8_t type) override {
        if (type == draco::SEQUENTIAL_ATTRIBUTE_ENCODER_INTEGER)
            return std::make_unique<FencedAttribute<draco::SequentialIntegerAttributeDecoder>>();
        if (type == draco::SEQUENTIAL_ATTRIBUTE_ENCODER_QUANTIZATION)
            return std::make_unique<
                FencedAttribute<draco::SequentialQuantizationAttributeDecoder>>();
        return SequentialAttributeDecodersController::CreateSequentialDecoder(type);
    }
};

/// A decoder that stops before the attributes take more memory than is due: one may have 255
/// components, and a stream any number of attributes.
template <class Decoder>
class Fenced : public Decoder {
  public:
    Fenced(uint64_t most_vertices, uint64_t limit) : most_(most_vertices), limit_(limit) {}

    [[nodiscard]] const char* fault() const { return fault_; }

  private:
    bool CreateAttributesDecoder(int32_t id) override {
        uint8_t head[3];  // connectivity, element, traversal
        if (!this->buffer()->Peek(head, sizeof head) || !Decoder::CreateAttributesDecoder(id))
            return false;
        if constexpr (std::is_same_v<Decoder, draco::MeshEdgebreakerDecoder>)
            return this->SetAttributesDecoder(
                id, std::make_unique<Controller>(std::make_unique<Sequencer>(
                        *this, id, head[1] == draco::MESH_VERTEX_ATTRIBUTE,
                        head[2] == draco::MESH_TRAVERSAL_PREDICTION_DEGREE)));
        return true;
    }

    bool DecodeAllAttributes() override {
        const draco::PointCloud& cloud = *this->point_cloud();
        if (cloud.num_points() > most_)
            fault_ = "its stream has too many vertices for so small a file";
        else if (attribute_bytes(cloud) > limit_)
            fault_ = "its stream is far too short for its attributes; the file is damaged";
        return !fault_ && Decoder::DecodeAllAttributes();
    }

    /// What decoding takes: the values, as integers too, and where each vertex finds its own.
    static uint64_t attribute_bytes(const draco::PointCloud& cloud) {
        uint64_t bytes = 0;
        for (int i = 0; i < cloud.num_attributes(); ++i) {
            const draco::PointAttribute& attribute = *cloud.attribute(i);
            bytes += uint64_t(attribute.byte_stride()) + 4u * attribute.num_components() + 8;
        }
        return bytes * cloud.num_points();
    }

    uint64_t most_, limit_;
    const char* fault_ = nullptr;
};

template <class Decoder>
const char* decode(std::span<const uint8_t> stream, uint64_t most_vertices, draco::Mesh& mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
    const draco::DecoderOptions options;
    Fenced<Decoder> decoder(most_vertices, draco_memory_limit(stream.size()));
    try {
        if (decoder.Decode(options, &buffer, &mesh).ok()) return nullptr;
    } catch (const std::length_error&) {  // a number from the stream that no vector can have
    }
    return decoder.fault() ? decoder.fault() : "its stream cannot be decoded; the file is damaged";
}

}  // namespace

const char* decode_draco_stream(std::span<const uint8_t> stream, const DracoHeader& header,
                                uint64_t most_vertices, draco::Mesh& mesh) {
    return header.connectivity == DracoConnectivity::Edgebreaker
               ? decode<draco::MeshEdgebreakerDecoder>(stream, most_vertices, mesh)
               : decode<draco::MeshSequentialDecoder>(stream, most_vertices, mesh);
}

}  // namespace petzval::io
