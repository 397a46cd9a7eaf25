#include "alcove/mesh/detail/interpolated_document.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alcove {
namespace {

using Bytes = std::vector<std::byte>;

template <class T>
void append(Bytes& to, T value) {
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    to.insert(to.end(), bytes, bytes + sizeof value);
}

template <class T>
void append_rounded(Bytes& to, double value) {
    // Clamped, because rounding errors may take the weighted sum out of range.
    constexpr double low = std::numeric_limits<T>::lowest(), high = std::numeric_limits<T>::max();
    append(to, static_cast<T>(std::clamp(std::round(value), low, high)));
}

void append(Bytes& to, double value, PlyType type) {
    switch (type) {
    case PlyType::int8:
        return append_rounded<std::int8_t>(to, value);
    case PlyType::uint8:
        return append_rounded<std::uint8_t>(to, value);
    case PlyType::int16:
        return append_rounded<std::int16_t>(to, value);
    case PlyType::uint16:
        return append_rounded<std::uint16_t>(to, value);
    case PlyType::int32:
        return append_rounded<std::int32_t>(to, value);
    case PlyType::uint32:
        return append_rounded<std::uint32_t>(to, value);
    case PlyType::float32:
        return append(to, static_cast<float>(value));
    case PlyType::float64:
        return append(to, value);
    }
}

/// Finds the rows of an element.
class Rows {
  public:
    explicit Rows(const PlyElement& element) : first_(element.rows.data()), stride_(element.smallest_row()) {
        if (!element.has_lists())
            return;
        const std::byte* at = first_;
        for (std::size_t row = 0; row < element.count; ++row) {
            begin_.push_back(static_cast<std::size_t>(at - first_));
            for (const PlyProperty& property : element.properties)
                at += stored_size(property, at);
        }
        begin_.push_back(static_cast<std::size_t>(at - first_));
    }
    const std::byte* operator[](std::size_t row) const {
        return first_ + (begin_.empty() ? row * stride_ : begin_[row]);
    }

  private:
    const std::byte* first_;
    std::size_t stride_;
    std::vector<std::size_t> begin_; ///< empty if all rows have the same size
};

/// The index of a property among the three whose names start at `first` and differ in the last letter: "x", "y" and
/// "z".
std::optional<int> component(const PlyProperty& property, std::string_view first) {
    std::string name(first);
    for (int c = 0; c < 3; ++c, ++name.back())
        if (property.name == name && !property.count_type)
            return c;
    return {};
}

class VertexElement {
  public:
    VertexElement(const PlyElement& old, const Mesh& mesh, const Mesh& result)
        : old_(old), rows_(old), result_(result), made_(old), has_normals_(!mesh.normals.empty()) {
        for (PlyProperty& property : made_.properties)
            if (component(property, "x") && is_integral(property.type)) {
                property.type = PlyType::float64; // midpoints are not integral
                retyped_ = true;
            }
    }

    PlyElement with(std::span<const AddedVertex> added) {
        Bytes rows;
        if (!retyped_)
            rows.assign(old_.rows.begin(), old_.rows.end());
        for (std::size_t v = 0; retyped_ && v < old_.count; ++v)
            append_retyped(rows, rows_[v]);
        for (std::size_t i = 0; i < added.size(); ++i)
            append_added(rows, added[i], old_.count + i);
        made_.count = old_.count + added.size();
        made_.keep(std::move(rows));
        return made_;
    }

  private:
    void append_retyped(Bytes& to, const std::byte* from) const {
        for (std::size_t p = 0; p < old_.properties.size(); ++p) {
            const PlyProperty& property = old_.properties[p];
            const std::size_t size = stored_size(property, from);
            if (made_.properties[p].type == property.type)
                to.insert(to.end(), from, from + size);
            else
                append(to, number_at(from, property.type), made_.properties[p].type);
            from += size;
        }
    }

    void append_added(Bytes& to, const AddedVertex& vertex, std::size_t number) const {
        const Vec3d& w = vertex.weights;
        const auto nearest = w.x >= w.y && w.x >= w.z ? 0u : w.y >= w.z ? 1u : 2u;
        std::array<const std::byte*, 3> at{rows_[vertex.between[0]], rows_[vertex.between[1]],
                                           rows_[vertex.between[2]]};
        for (std::size_t p = 0; p < old_.properties.size(); ++p) {
            const PlyProperty& property = old_.properties[p];
            const PlyType type = made_.properties[p].type;
            const auto normal = has_normals_ && !is_integral(type) ? component(property, "nx") : std::nullopt;
            if (property.count_type)
                to.insert(to.end(), at[nearest], at[nearest] + stored_size(property, at[nearest]));
            else if (const auto axis = component(property, "x"))
                append(to, result_.positions[number][*axis], type);
            else if (normal)
                append(to, result_.normals[number][*normal], type);
            else
                append(to, blended(w, [&](int i) { return number_at(at[std::size_t(i)], property.type); }), type);
            for (const std::byte*& row : at)
                row += stored_size(property, row);
        }
    }

    const PlyElement& old_;
    const Rows rows_;
    const Mesh& result_;
    PlyElement made_;
    bool has_normals_, retyped_ = false;
};

class FaceElement {
  public:
    FaceElement(const PlyElement& old, const Mesh& mesh, const Mesh& result)
        : old_(old), rows_(old), mesh_(mesh), made_(old) {
        for (PlyProperty& property : made_.properties)
            if (is_corners(property) && !holds(property.type, result.vertex_count()))
                property.type = holds(PlyType::int32, result.vertex_count()) ? PlyType::int32 : PlyType::uint32;
    }

    PlyElement cut_by(const Bisection& bisection) {
        Bytes rows;
        const std::vector<Piece>& pieces = bisection.pieces();
        std::size_t piece = 0;
        made_.count = 0;
        for (std::uint32_t f = 0; f < old_.count; ++f) {
            if (!bisection.is_cut(f)) {
                append_row(rows, f, nullptr);
                while (piece < pieces.size() && pieces[piece].face == f)
                    ++piece;
            }
            for (; piece < pieces.size() && pieces[piece].face == f; ++piece)
                append_row(rows, f, &pieces[piece]);
        }
        made_.keep(std::move(rows));
        return made_;
    }

  private:
    static bool holds(PlyType type, std::size_t vertices) {
        return vertices <= std::size_t(1) << (8 * size_of(type) - (type == PlyType::int8 || type == PlyType::int16 ||
                                                                   type == PlyType::int32));
    }

    /// Whether the property is the list of vertex indices that read_ply() uses.
    bool is_corners(const PlyProperty& property) const {
        const std::string_view name = old_.find("vertex_indices") ? "vertex_indices" : "vertex_index";
        return property.name == name && property.count_type;
    }

    void append_row(Bytes& to, std::uint32_t face, const Piece* piece) {
        ++made_.count;
        const std::byte* from = rows_[face];
        for (std::size_t p = 0; p < old_.properties.size(); ++p) {
            const PlyProperty& property = old_.properties[p];
            const std::size_t size = stored_size(property, from);
            const PlyType type = made_.properties[p].type;
            if (is_corners(property) && (piece || type != property.type)) {
                const auto corners = piece ? std::span<const std::uint32_t>(piece->vertices) : mesh_.face(face);
                append(to, static_cast<double>(corners.size()), *property.count_type);
                for (const std::uint32_t v : corners)
                    append(to, v, type);
            } else if (piece && has_corner_uvs(property, from, face)) {
                append_uvs(to, property, from + size_of(*property.count_type), *piece);
            } else {
                to.insert(to.end(), from, from + size);
            }
            from += size;
        }
    }

    bool has_corner_uvs(const PlyProperty& property, const std::byte* list, std::uint32_t face) const {
        return property.name == "texcoord" && property.count_type &&
               static_cast<std::size_t>(integer_at(list, *property.count_type)) == 2 * mesh_.face(face).size();
    }

    void append_uvs(Bytes& to, const PlyProperty& property, const std::byte* items, const Piece& piece) const {
        append(to, 6.0, *property.count_type);
        const std::uint32_t first = mesh_.face_begin[piece.face];
        for (const Vec3d& weights : piece.weights)
            for (std::size_t c = 0; c < 2; ++c)
                append(to,
                       blended(weights,
                               [&](int i) {
                                   const std::size_t corner = piece.corners[std::size_t(i)] - first;
                                   return number_at(items + (2 * corner + c) * size_of(property.type), property.type);
                               }),
                       property.type);
    }

    const PlyElement& old_;
    const Rows rows_;
    const Mesh& mesh_;
    PlyElement made_;
};

}

std::shared_ptr<const PlyDocument> interpolated_document(const PlyDocument& document, const Mesh& mesh,
                                                         const Mesh& result, const Bisection& bisection) {
    auto made = std::make_shared<PlyDocument>(document);
    for (PlyElement& element : made->elements)
        if (element.name == "vertex")
            element = VertexElement(*document.find("vertex"), mesh, result).with(bisection.added());
        else if (element.name == "face")
            element = FaceElement(*document.find("face"), mesh, result).cut_by(bisection);
    return made;
}

}
