/*---------------------------------------------------------------------------*\
    Part of sdph, GPL-3.0-or-later. Links against OpenFOAM (GPL-3).
\*---------------------------------------------------------------------------*/

#include "noSlipSource.H"
#include "twoPhaseSystem.H"
#include "dragModel.H"
#include "fvMatrices.H"
#include "fvmSup.H"
#include "mathematicalConstants.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace fv
{
    defineTypeNameAndDebug(noSlipSource, 0);
    addToRunTimeSelectionTable(option, noSlipSource, dictionary);
}
}


Foam::fv::noSlipSource::noSlipSource
(
    const word& name,
    const word& modelType,
    const dictionary& dict,
    const fvMesh& mesh
)
:
    option(name, modelType, dict, mesh),
    phase_(dict.get<word>("phase")),
    residualAlpha_(dict.get<scalar>("residualAlpha"))
{
    fieldNames_ = wordList(1, IOobject::groupName("Theta", phase_));
    applied_ = boolList(1, false);
}


void Foam::fv::noSlipSource::addSup
(
    const volScalarField& alpha,
    const volScalarField& rho,
    fvMatrix<scalar>& eqn,
    const label fieldi
)
{
    const twoPhaseSystem& fluid = mesh_.lookupObject<twoPhaseSystem>("phaseProperties");
    const phaseModel& grains = fluid.phase1().name() == phase_ ? fluid.phase1() : fluid.phase2();
    const phaseModel& gas = fluid.otherPhase(grains);
    const volScalarField& Theta = eqn.psi();
    const dimensionedScalar small("small", Theta.dimensions(), 1.0e-6);  // as in kineticTheoryModel.C
    const volScalarField beta(fluid.lookupSubModel<dragModel>(grains, gas).K());
    const volScalarField J2
    (
        0.25*sqr(beta)*grains.d()*magSqr(grains.U() - gas.U())
       /(
            max(alpha, dimensionedScalar("residualAlpha", dimless, residualAlpha_))*rho
           *sqrt(constant::mathematical::pi)*(sqrt(Theta) + sqrt(small))
        )
    );
    eqn -= fvm::Sp(J2/(Theta + small), Theta);
}
