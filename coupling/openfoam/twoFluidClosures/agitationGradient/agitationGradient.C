/*---------------------------------------------------------------------------*\
    Part of sdph, GPL-3.0-or-later. Links against OpenFOAM (GPL-3).
\*---------------------------------------------------------------------------*/

#include "agitationGradient.H"
#include "fvMatrices.H"
#include "fvcGrad.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace fv
{
    defineTypeNameAndDebug(agitationGradient, 0);
    addToRunTimeSelectionTable(option, agitationGradient, dictionary);
}
}


Foam::fv::agitationGradient::agitationGradient
(
    const word& name,
    const word& modelType,
    const dictionary& dict,
    const fvMesh& mesh
)
:
    option(name, modelType, dict, mesh),
    phase_(dict.get<word>("phase")),
    e_(dict.get<scalar>("e"))
{
    fieldNames_ = wordList(1, IOobject::groupName("U", phase_));
    applied_ = boolList(1, false);
}


void Foam::fv::agitationGradient::addSup
(
    const volScalarField& alpha,
    const volScalarField& rho,
    fvMatrix<vector>& eqn,
    const label fieldi
)
{
    const volScalarField& Theta =
        mesh_.lookupObject<volScalarField>(IOobject::groupName("Theta", phase_));
    const volScalarField& g0 =
        mesh_.lookupObject<volScalarField>(IOobject::groupName("gs0", phase_));

    eqn -=
        alpha*rho*(scalar(1) + 2.0*(1.0 + e_)*alpha*g0)*fvc::grad(Theta);
}
