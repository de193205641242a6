/*---------------------------------------------------------------------------*\
    Part of sdph, GPL-3.0-or-later. Links against OpenFOAM (GPL-3).
\*---------------------------------------------------------------------------*/

#include "noEddyHeat.H"
#include "fvMatrices.H"
#include "fvmLaplacian.H"
#include "surfaceInterpolate.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace fv
{
    defineTypeNameAndDebug(noEddyHeat, 0);
    addToRunTimeSelectionTable(option, noEddyHeat, dictionary);
}
}


Foam::fv::noEddyHeat::noEddyHeat
(
    const word& name,
    const word& modelType,
    const dictionary& dict,
    const fvMesh& mesh
)
:
    option(name, modelType, dict, mesh),
    phase_(dict.get<word>("phase"))
{
    fieldNames_ = wordList(1, IOobject::groupName("h", phase_));
    applied_ = boolList(1, false);
}


void Foam::fv::noEddyHeat::addSup
(
    const volScalarField& alpha,
    const volScalarField& rho,
    fvMatrix<scalar>& eqn,
    const label fieldi
)
{
    const volScalarField& nut =
        mesh_.lookupObject<volScalarField>(IOobject::groupName("nut", phase_));

    eqn -= fvm::laplacian(fvc::interpolate(alpha)*fvc::interpolate(rho*nut), eqn.psi());
}
