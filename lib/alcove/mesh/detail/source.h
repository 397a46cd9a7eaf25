/// What a file held beyond the Mesh itself, kept so that writing the same format again gives it back.
#pragma once

#include <string_view>

namespace alcove {

/// Base of PlyDocument and ObjDocument. Belongs to the vertices and faces it was read with: code that moves,
/// reorders or removes them resets `Mesh::source`.
class SourceDocument {
  public:
    virtual ~SourceDocument() = default;
    /// Whether each vertex came with a value of that name ("quality", "red", ...) that writing gives back.
    virtual bool has_vertex_property(std::string_view) const { return false; }
    /// Whether a comment line of the file begins with that text.
    virtual bool has_comment(std::string_view) const { return false; }

  protected:
    SourceDocument() = default;
    SourceDocument(const SourceDocument&) = default;
    SourceDocument& operator=(const SourceDocument&) = default;
};

}
