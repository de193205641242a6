/*---------------------------------------------------------------------------*\
    Part of sdph, GPL-3.0-or-later. Links against OpenFOAM (GPL-3).
\*---------------------------------------------------------------------------*/

#include "gunn.H"
#include "phasePair.H"
#include "Enum.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace heatTransferModels
{
    defineTypeNameAndDebug(gunn, 0);
    addToRunTimeSelectionTable(heatTransferModel, gunn, dictionary);
}
}

namespace
{
    const Foam::Enum<bool> slipOfReynolds
    ({
        { true, "superficial" },
        { false, "interstitial" },
    });
}


Foam::heatTransferModels::gunn::gunn
(
    const dictionary& dict,
    const phasePair& pair
)
:
    heatTransferModel(dict, pair),
    superficial_(slipOfReynolds.get("reynolds", dict)),
    alphaGas_(dict.get<Switch>("alphaGas"))
{}


Foam::heatTransferModels::gunn::~gunn()
{}


Foam::tmp<Foam::volScalarField> Foam::heatTransferModels::gunn::Nu() const
{
    const volScalarField a(scalar(1) - pair_.dispersed());
    const volScalarField cbrtPr(cbrt(pair_.Pr()));

    volScalarField Re("Re", pair_.Re());
    if (superficial_)
    {
        Re *= a;
    }

    return
        (7.0 - 10.0*a + 5.0*sqr(a))*(1.0 + 0.7*pow(Re, 0.2)*cbrtPr)
      + (1.33 - 2.4*a + 1.2*sqr(a))*pow(Re, 0.7)*cbrtPr;
}


Foam::tmp<Foam::volScalarField> Foam::heatTransferModels::gunn::K() const
{
    // In cells without grains the residual fraction keeps the temperature of
    // the absent phase at that of the gas
    tmp<volScalarField> tK
    (
        6.0
       *max(pair_.dispersed(), residualAlpha_)
       *pair_.continuous().kappa()
       *Nu()
       /sqr(pair_.dispersed().d())
    );

    if (alphaGas_)
    {
        tK.ref() *= scalar(1) - pair_.dispersed();
    }

    return tK;
}
