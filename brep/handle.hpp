// The kernel's counted references, by a name that reads like a type.

#ifndef CAG_BREP_HANDLE_HPP
#define CAG_BREP_HANDLE_HPP

#include <Standard_Handle.hxx>

namespace brep {

template <typename T> using Ref = opencascade::handle<T>;

} // namespace brep

#endif
