/// Adapts the contents of a PLY file to a tessellated mesh.
#pragma once

#include "alcove/mesh/detail/bisection.h"
#include "alcove/mesh/formats/ply/ply_document.h"

namespace alcove {

/// Keeps comments, properties, the rows of existing vertices and of faces that were not cut, and other elements.
///
/// Numeric properties of an added vertex are interpolated and rounded to the type of the property; its list properties
/// are those of the nearest vertex. The pieces of a face have the properties of the face, except the indices and
/// `texcoord`. A property changes its type in two cases only: integral coordinates become doubles, and indices that
/// exceed their type get a larger one.
///
/// `mesh` is the mesh of the document. `result` is the tessellated mesh; only its positions and normals are used.
std::shared_ptr<const PlyDocument> interpolated_document(const PlyDocument& document, const Mesh& mesh,
                                                         const Mesh& result, const Bisection& bisection);

}
