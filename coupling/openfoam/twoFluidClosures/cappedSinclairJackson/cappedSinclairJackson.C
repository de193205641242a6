/*---------------------------------------------------------------------------*\
    Part of sdph, GPL-3.0-or-later. Links against OpenFOAM (GPL-3).
\*---------------------------------------------------------------------------*/

#include "cappedSinclairJackson.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace kineticTheoryModels
{
namespace radialModels
{
    defineTypeNameAndDebug(cappedSinclairJackson, 0);
    addToRunTimeSelectionTable(radialModel, cappedSinclairJackson, dictionary);
}
}
}


Foam::kineticTheoryModels::radialModels::cappedSinclairJackson::
cappedSinclairJackson(const dictionary& dict)
:
    radialModel(dict),
    margin_(dict.subDict(typeName + "Coeffs").get<scalar>("margin"))
{}


Foam::tmp<Foam::volScalarField>
Foam::kineticTheoryModels::radialModels::cappedSinclairJackson::x
(
    const volScalarField& alpha,
    const dimensionedScalar& alphaMax
) const
{
    return cbrt(min(alpha, alphaMax - margin_)/alphaMax);
}


Foam::tmp<Foam::volScalarField>
Foam::kineticTheoryModels::radialModels::cappedSinclairJackson::g0
(
    const volScalarField& alpha,
    const dimensionedScalar&,
    const dimensionedScalar& alphaMax
) const
{
    return 1.0/(1.0 - x(alpha, alphaMax));
}


Foam::tmp<Foam::volScalarField>
Foam::kineticTheoryModels::radialModels::cappedSinclairJackson::g0prime
(
    const volScalarField& alpha,
    const dimensionedScalar&,
    const dimensionedScalar& alphaMax
) const
{
    // At least 1e-3, as in OpenFOAM's: without grains the slope has a pole
    const volScalarField root(x(max(alpha, scalar(1e-3)), alphaMax));

    return 1.0/(3.0*alphaMax*sqr(root - sqr(root)));
}
