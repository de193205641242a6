/*---------------------------------------------------------------------------*\
    Part of sdph, GPL-3.0-or-later. Links against OpenFOAM (GPL-3).
\*---------------------------------------------------------------------------*/

#include "blendedGidaspow.H"
#include "phasePair.H"
#include "Ergun.H"
#include "WenYu.H"
#include "mathematicalConstants.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace dragModels
{
    defineTypeNameAndDebug(blendedGidaspow, 0);
    addToRunTimeSelectionTable(dragModel, blendedGidaspow, dictionary);
}
}


Foam::dragModels::blendedGidaspow::blendedGidaspow
(
    const dictionary& dict,
    const phasePair& pair,
    const bool registerObject
)
:
    dragModel(dict, pair, registerObject),
    ergun_(new Ergun(dict, pair, false)),
    wenYu_(new WenYu(dict, pair, false))
{}


Foam::dragModels::blendedGidaspow::~blendedGidaspow()
{}


Foam::tmp<Foam::volScalarField>
Foam::dragModels::blendedGidaspow::CdRe() const
{
    const volScalarField phi
    (
        atan(150.0*1.75*(0.2 - pair_.dispersed()))
       /constant::mathematical::pi
      + 0.5
    );

    return (1.0 - phi)*ergun_->CdRe() + phi*wenYu_->CdRe();
}
