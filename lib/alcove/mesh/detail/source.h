/// The contents of a file that a Mesh does not represent, kept to be written back in the same format.
#pragma once

#include "alcove/base/types.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace alcove {

/// Base class of PlyDocument, ObjDocument and GltfDocument. Valid only for the vertices and faces that were read with
/// it: code that moves, reorders or removes them must reset `Mesh::source`.
class SourceDocument {
  public:
    virtual ~SourceDocument() = default;
    /// Whether the vertices have values of that name ("quality", "red", ...) that are written back.
    virtual bool has_vertex_property(std::string_view) const { return false; }
    /// The first comment of the file that begins with that text; empty if there is none.
    virtual std::string_view comment(std::string_view) const { return {}; }

    /// Descriptions of the contents that no Mesh represents and other formats do not store, such as "3 comment lines".
    virtual std::vector<std::string> contents() const = 0;
    /// The number of sets of texture coordinates, including the one in the Mesh, and the values of one set, per vertex.
    virtual std::size_t uv_sets() const { return 1; }
    virtual std::vector<Vec2> uv_set(std::size_t) const { return {}; }

  protected:
    SourceDocument() = default;
    SourceDocument(const SourceDocument&) = default;
    SourceDocument& operator=(const SourceDocument&) = default;
};

/// Whether a comment about an earlier run, such as "alcove 0.2.0: ao, convexity by exact:64", names a value.
inline bool names_value(std::string_view comment, std::string_view value) {
    const auto is_letter = [](char c) { return c == '_' || (c >= 'a' && c <= 'z'); };
    for (std::size_t at = 0; (at = comment.find(value, at)) != std::string_view::npos; ++at) {
        const std::size_t end = at + value.size();
        if ((at == 0 || !is_letter(comment[at - 1])) && (end == comment.size() || !is_letter(comment[end])))
            return true;
    }
    return false;
}

}
