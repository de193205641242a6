/*---------------------------------------------------------------------------*\
gasTurbulence: turbulence of sdphGasFoam. Copyright (C) 2025 the sdph authors.
This program is free software: you can redistribute it and/or modify it under
the terms of the GNU General Public License as published by the Free Software
Foundation, either version 3 of the License, or (at your option) any later
version. It comes WITHOUT ANY WARRANTY; see <http://www.gnu.org/licenses/>.
\*---------------------------------------------------------------------------*/
// OpenFOAM's models of turbulence, weighted with alpha rho as those of its two-fluid solvers, for a gas that tells its
// viscosity. Their templates are OpenFOAM's; only what tells them of the gas stands here.

#ifndef OPENFOAM
#error "turbulence of the gas needs OpenFOAM of openfoam.com; leave [gas.turbulence] out"
#endif

#include "turbulence.H"

#include "PhaseCompressibleTurbulenceModel.H"
#include "addToRunTimeSelectionTable.H"
#include "makeTurbulenceModel.H"
#include "laminarModel.H"
#include "Stokes.H"
#include "RASModel.H"
#include "LESModel.H"
#include "kEpsilon.H"
#include "kOmegaSST.H"
#include "WALE.H"
#include "fvOptions.H"

namespace Foam
{

// The gas as a model asks for it
class GasTransport
{
    const TurbulentGas gas_;

public:

    explicit GasTransport(const TurbulentGas& gas) : gas_(gas) {}

    tmp<volScalarField> mu() const { return gas_.mu; }
    tmp<scalarField> mu(const label patchi) const { return gas_.mu.boundaryField()[patchi]; }
    tmp<volScalarField> nu() const { return gas_.mu/gas_.rho; }
    tmp<scalarField> nu(const label patchi) const { return mu(patchi)/gas_.rho.boundaryField()[patchi]; }
};

} // namespace Foam

makeTurbulenceModelTypes(volScalarField, volScalarField, compressibleTurbulenceModel, PhaseCompressibleTurbulenceModel, GasTransport);
makeBaseTurbulenceModel(volScalarField, volScalarField, compressibleTurbulenceModel, PhaseCompressibleTurbulenceModel, GasTransport);
makeTemplatedTurbulenceModel(GasTransportPhaseCompressibleTurbulenceModel, laminar, Stokes);  // the base of models names it
makeTemplatedTurbulenceModel(GasTransportPhaseCompressibleTurbulenceModel, RAS, kEpsilon);
makeTemplatedTurbulenceModel(GasTransportPhaseCompressibleTurbulenceModel, RAS, kOmegaSST);
makeTemplatedTurbulenceModel(GasTransportPhaseCompressibleTurbulenceModel, LES, WALE);

namespace Foam
{

// Sees k, epsilon and omega between their equations and OpenFOAM's bound on them: models ask the options of the mesh then
class BoundWatch : public fv::option
{
    scalar& share_;

public:

    BoundWatch(const fvMesh& mesh, scalar& share) : fv::option("boundWatch", "boundWatch", dictionary(), mesh), share_(share)
    {
        fieldNames_ = wordList{"k", "epsilon", "omega"};
        applied_.setSize(fieldNames_.size(), true);
    }

    virtual void correct(volScalarField& field)
    {
        const scalarField& values = field.primitiveField();
        share_ = max(share_, gSum(scalarField(max(-values, scalar(0))))/max(gSum(mag(values)()), VSMALL));
    }
};

class OwnTurbulence : public Turbulence
{
    const GasTransport transport_;
    autoPtr<PhaseCompressibleTurbulenceModel<GasTransport>> model_;
    const fvMesh& mesh_;
    scalar bounded_ = 0;

public:

    explicit OwnTurbulence(const TurbulentGas& gas)
    :
        transport_(gas),
        model_(PhaseCompressibleTurbulenceModel<GasTransport>::New(gas.alpha, gas.rho, gas.U, gas.alphaRhoPhi, gas.phi, transport_)),
        mesh_(gas.U.mesh())
    {
        if (model_().type() != gas.model)
            FatalErrorInFunction << "constant/turbulenceProperties has the model " << model_().type()
                << "; constant/gasProperties has " << gas.model << ": make them the same" << exit(FatalError);
        static_cast<PtrList<fv::option>&>(fv::options::New(mesh_)).append(new BoundWatch(mesh_, bounded_));
    }

    const volScalarField& nut() const { return mesh_.lookupObject<volScalarField>("nut"); }
    tmp<volScalarField> energy() const { return model_().k(); }
    tmp<volScalarField> dissipation() const { return model_().epsilon(); }

    void begin() { model_().validate(); }

    void correct()
    {
        bounded_ = 0;
        model_().correct();
    }

    scalar bounded() const { return bounded_; }

    std::vector<volScalarField*> fields()
    {
        std::vector<volScalarField*> found;
        for (const word name : {"k", "epsilon", "omega", "nut"})
            if (mesh_.foundObject<volScalarField>(name)) found.push_back(&mesh_.lookupObjectRef<volScalarField>(name));
        return found;
    }
};

} // namespace Foam

extern "C" Foam::Turbulence* makeTurbulence(const Foam::TurbulentGas& gas)
{
    return new Foam::OwnTurbulence(gas);
}
