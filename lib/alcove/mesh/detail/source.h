/// The contents of a file that a Mesh does not represent, kept to be written back in the same format.
#pragma once

#include <string_view>

namespace alcove {

/// Base of PlyDocument and ObjDocument. Valid only for the vertices and faces that were read with it: code that moves,
/// reorders or removes them must reset `Mesh::source`.
class SourceDocument {
  public:
    virtual ~SourceDocument() = default;
    /// Whether each vertex has a value of that name ("quality", "red", ...) that is written back.
    virtual bool has_vertex_property(std::string_view) const { return false; }
    /// Whether a comment line of the file begins with that text.
    virtual bool has_comment(std::string_view) const { return false; }

  protected:
    SourceDocument() = default;
    SourceDocument(const SourceDocument&) = default;
    SourceDocument& operator=(const SourceDocument&) = default;
};

}
