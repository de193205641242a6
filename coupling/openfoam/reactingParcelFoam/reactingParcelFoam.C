// OpenFOAM's own reactingParcelFoam, compiled so that products of fields are right on cells that are no boxes: there
// `tensorField & tmp<vectorField>` reads what it is writing, and __restrict__ lets GCC get it wrong (Make/options).

#include "lagrangian/reactingParcelFoam/reactingParcelFoam.C"
